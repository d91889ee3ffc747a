#!/usr/bin/env bash
# Sets up a bare Debian (12 or 13) to build, run and test this workspace; run again, it does only what is missing.
#
#   scripts/setup.sh                 everything needed to run
#   scripts/setup.sh --tests         also what only the tests need
#   scripts/setup.sh --workers       also what the trials' WORKERS= and SCHEDULER= need (Dask); included in --tests
#   scripts/setup.sh --learning      also what only the learning environments need (Gymnasium); included in --tests
#   scripts/setup.sh --debugging     also what only attaching a debugger needs (debugpy); included in --tests
#   scripts/setup.sh --site          also what only make site needs (mkdocs); included in --tests
#   scripts/setup.sh --lab           also what only make lab needs (JupyterLab); included in --tests
#   scripts/setup.sh --wheels        also what only make wheels needs (setuptools); included in --tests
#   scripts/setup.sh --cpp           also build the lessons' C++ programs, from now on; included in --tests
#   scripts/setup.sh --bashrc        also source the workspace in ~/.bashrc, for each new terminal
#   scripts/setup.sh --build         build even if nothing has changed
#   scripts/setup.sh --dependencies  everything but the build
#
# MIRROR=cn, or a Debian archive's address, in the environment: where the packages come from (setup/mirror.sh).
# dependencies/ lists what is installed, for each release and architecture. Stamps and logs are in .setup/. A stamp is
# written last, so an interrupted step is done again.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

debian_mb=2000  # measured: 1550 installed, 405 in apt's cache
python_mb=1150  # measured: 830 installed, 250 in pip's cache and while it unpacks
build_mb=40     # measured: 8 with the packages of the first release

# Also where what runs has taken Ctrl-C for a fault of its own: a sum of half of the files would begin a new build.
trap 'trap - INT; kill -INT $$' INT
state=$root/.setup venv=$root/.venv
tests=no workers=no learning=no debugging=no site=no lab=no wheels=no cpp=OFF force_build=no build=yes bashrc=no
for option in "$@"; do
  case "$option" in
    --tests) tests=yes workers=yes learning=yes debugging=yes site=yes lab=yes wheels=yes cpp=ON ;;
    --workers) workers=yes ;;
    --learning) learning=yes ;;
    --debugging) debugging=yes ;;
    --site) site=yes ;;
    --lab) lab=yes ;;
    --wheels) wheels=yes ;;
    --cpp) cpp=ON ;;
    --bashrc) bashrc=yes ;;
    --build) force_build=yes ;;
    --dependencies) build=no ;;
    *) fail $"unknown option $option; there are --tests, --workers, --learning, --debugging, --site, --lab, --wheels, --cpp, --bashrc, --build and --dependencies" ;;
  esac
done
did=no
step() { did=yes; say $"Step $1 of 5: $2"; }
for part in logged machine mirror debian python source_packages workspace; do . "$root/scripts/setup/$part.sh"; done

check_machine
mkdir -p "$state"
use_mirror "$state" "${platform%-*}"
exec 9<"$root"  # two setups at once would interfere with each other
flock -n 9 || { say $"Another setup is running in this folder: waiting for it."; flock 9; }
mapfile -t missing < <(missing_packages)
if [ ${#missing[@]} -gt 0 ] || ! venv_is_sound; then
  step 1 $"checking this machine"
  [ ${#missing[@]} -eq 0 ] || check_rights
  check_disk $((debian_mb * ${#missing[@]} / $(wanted_packages | wc -l))) \
    $((build_mb + $(venv_is_sound && echo 0 || echo "$python_mb")))
fi
debian_packages
python_environment
python_packages
[ "$build" = no ] || build_workspace
[ "$did" = yes ] && say $"Set up in ${SECONDS} s." || say $"Nothing to set up."
[ "$bashrc" = no ] || source_in_bashrc
if [ "$did$build" = yesyes ] && ! grep -qsxF "$(bashrc_line)" "${HOME:-}/.bashrc"; then
  line=$(terminal_line)
  say $"In each new terminal type: $line (or, once for all: make setup BASHRC=1)"
fi
