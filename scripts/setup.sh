#!/usr/bin/env bash
# Makes a bare Debian 12 able to build, run and test this workspace; run again, it does only what is missing.
#
#   scripts/setup.sh                 everything that running needs
#   scripts/setup.sh --tests         and what only the tests need
#   scripts/setup.sh --bench         and what only the benchmark needs (its chart); the tests need it too
#   scripts/setup.sh --build         build even where no input of the build has changed
#   scripts/setup.sh --dependencies  all but the build
#
# Stamps and logs lie in .setup/. A stamp is written last, so whatever was interrupted is done again.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

debian_mb=2000  # measured: 1550 installed, 405 in apt's cache
python_mb=1150  # measured: 830 installed, 250 in pip's cache and while it unpacks
build_mb=40     # measured: 8 with the packages of the first release

state=$root/.setup venv=$root/.venv
tests=no bench=no force_build=no build=yes
for option in "$@"; do
  case "$option" in
    --tests) tests=yes bench=yes ;;
    --bench) bench=yes ;;
    --build) force_build=yes ;;
    --dependencies) build=no ;;
    *) fail "unknown option $option; there are --tests, --bench, --build and --dependencies" ;;
  esac
done
did=no
step() { did=yes; say "Step $1 of 5: $2"; }

# Runs a command with its output in a log, and says every 20 s that it is still at it.
logged() {
  local log=$state/$1.log beat rc=0
  shift
  (
    trap - EXIT
    while ! read -rt 20 && kill -0 $$ 2>/dev/null; do say "  still at it, ${SECONDS} s since the start"; done <> <(:)
  ) 9<&- 2>/dev/null &
  beat=$!
  trap 'kill $beat 2>/dev/null' EXIT
  "$@" >"$log" 2>&1 </dev/null || rc=$?
  kill "$beat" 2>/dev/null
  wait "$beat" 2>/dev/null || true
  trap - EXIT
  return $rc
}

# fail, with the last telling line of a log.
fail_with_log() {
  local why
  why=$(awk '/^CMake Error/ && !cmake {cmake = $0; next} cmake && !told && NF {told = $0} /^E:|^ERROR|[Ee]rror:/ {last = $0}
    END {sub(/^ +/, "", told); print cmake ? cmake " " told : last}' "$state/$2.log")
  fail "$1${why:+: $why} (all of it in .setup/$2.log)"
}
# The same for a build: the first cause in the build's own lines.
fail_with_cause() {
  python3 "$root/scripts/build_cause.py" "$state/build.log" >&2
  fail "$1 (all of it in .setup/build.log)"
}
network_failed() {
  grep -qaE 'Temporary failure|Could not resolve|Failed to fetch|Could not connect|Network is unreachable|Connection (refused|timed out)|NewConnectionError|ConnectTimeout|NameResolution|ProxyError|Max retries' "$state/$1.log"
}

# --- 1: this machine
check_machine() {
  local id='' version='' name=''
  [ -r /etc/os-release ] && eval "$(. /etc/os-release; printf 'id=%q version=%q name=%q' "${ID:-}" "${VERSION_ID:-}" "${PRETTY_NAME:-}")"
  [ "$id $version" = "debian 12" ] ||
    fail "this is ${name:-no Debian}, and the ROS packages used here are Debian 12's: use Debian 12, or docker/ in this repository"
  [ "$(dpkg --print-architecture)" = amd64 ] ||
    fail "this is a $(dpkg --print-architecture) machine, and PyBullet is built for amd64 (64-bit Intel or AMD) only"
  case "$root" in
    *[[:space:]:\;\"\'\$\&\#\(\)\\]*)
      fail "the folder's name \"$root\" has a blank or one of : ; \" ' \$ & # ( ) \\, which catkin cannot take: move the folder" ;;
  esac
  [ -w "$root" ] || fail "$(id -un) may not write in $root: run as its owner, $(stat -c %U "$root")"
}

free_mb() { df -Pm "$1" 2>/dev/null | awk 'NR==2 {print $4}'; }
check_disk() {  # MB that Debian's packages need below /usr, MB that this folder needs
  local system=$1 here=$2 free
  if [ "$(stat -c %d /usr)" = "$(stat -c %d "$root")" ]; then here=$((here + system)) system=0; fi
  free=$(free_mb /usr)
  [ "${free:-$system}" -ge "$system" ] || fail "too little disk: /usr has $free MB free, $system MB are needed"
  free=$(free_mb "$root")
  [ "${free:-$here}" -ge "$here" ] || fail "too little disk: $root has $free MB free, $here MB are needed"
}

check_rights() {
  [ "$(id -u)" != 0 ] || return 0
  local how="run \`make setup\` once as root, or as a user who may use sudo"
  command -v sudo >/dev/null || fail "Debian packages are missing, you are not root and there is no sudo: $how"
  if [ -t 0 ]; then sudo -v; else sudo -n true 2>/dev/null; fi ||
    fail "Debian packages are missing, you are not root and sudo refused $(id -un): $how"
}

# --- 2: Debian packages
wanted_packages() { sed 's/#.*//' "$root/scripts/debian-packages.txt" | awk 'NF {print $1}' | sort -u; }
missing_packages() {
  wanted_packages | xargs dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null |
    awk '$2 == "installed" {print $1}' | sort -u | comm -13 - <(wanted_packages) || true
}
as_root() {
  local keep=(DEBIAN_FRONTEND=noninteractive LC_ALL=C PATH="$PATH") name
  for name in http_proxy https_proxy no_proxy; do [ -z "${!name:-}" ] || keep+=("$name=${!name}"); done
  if [ "$(id -u)" = 0 ]; then env "${keep[@]}" "$@"; else sudo env "${keep[@]}" "$@"; fi
}
apt() { as_root apt-get -q -y -o DPkg::Lock::Timeout=600 -o Acquire::Retries=2 -o Dpkg::Use-Pty=0 "$@"; }
install_packages() { apt install --no-install-recommends "${missing[@]}"; }
mend_and_install() { as_root dpkg --configure -a && apt install -f && install_packages; }
debian_packages() {
  [ ${#missing[@]} -gt 0 ] || return 0
  step 2 "installing ${#missing[@]} Debian packages and what they depend on (some minutes, 360 MB on a bare machine)"
  logged apt-update apt update || fail_with_log "apt-get update failed" apt-update
  logged apt-install install_packages || diagnose_apt
}
# What was unpacked but not configured, an earlier setup being killed, can be mended; the rest is the person's to mend.
diagnose_apt() {
  ! network_failed apt-install || fail "no network: apt cannot fetch the packages (.setup/apt-install.log says more); connect and run this again"
  if grep -q 'Unable to locate package' "$state/apt-install.log"; then
    ! network_failed apt-update || fail "no network: apt cannot reach the package archive (.setup/apt-update.log says more); connect and run this again"
    fail "apt does not know all packages: /etc/apt/sources.list needs a line like \"deb http://deb.debian.org/debian bookworm main\""
  fi
  logged apt-mend mend_and_install || fail_with_log "apt-get install failed" apt-mend
}

# --- 3 and 4: Python environment and packages
venv_is_sound() {
  [ ! -e "$state/venv-unfinished" ] && [ -x "$venv/bin/pip" ] &&
    [ "$(cat "$state/venv" 2>/dev/null || echo "$venv")" = "$venv" ] &&
    grep -q '^include-system-site-packages = true' "$venv/pyvenv.cfg" && grep -q '^home = /usr/bin$' "$venv/pyvenv.cfg" &&
    "$venv/bin/python3" -c '' 2>/dev/null
}
python_environment() {
  ! venv_is_sound || return 0
  step 3 "making the Python environment .venv"
  rm -rf "$venv" "$state"/requirements*
  touch "$state/venv-unfinished"
  logged venv /usr/bin/python3 -m venv --system-site-packages "$venv" || fail_with_log "python3 -m venv failed" venv
  echo "$venv" >"$state/venv"
}
python_packages() {
  local file target
  for file in requirements.txt requirements-rosdep.txt $([ "$tests" = no ] || echo requirements-test.txt) \
    $([ "$bench" = no ] || echo requirements-bench.txt); do
    ! cmp -s "$root/$file" "$state/$file" || continue
    step 4 "installing the Python packages of $file"
    touch "$state/venv-unfinished"
    target=(--no-user)
    if [ "$file" = requirements-rosdep.txt ]; then target=(--target "$venv/rosdep" --upgrade); fi
    logged pip env -u PIP_USER -u PIP_TARGET -u PIP_PREFIX "$venv/bin/python3" -I -m pip install "${target[@]}" --no-input \
      --disable-pip-version-check --no-deps --only-binary :all: -r "$root/$file" || {
      ! network_failed pip || fail "no network: pip cannot reach its package index (.setup/pip.log says more); connect and run this again"
      fail_with_log "pip install failed" pip
    }
    cp "$root/$file" "$state/$file"
  done
  rm -f "$state/venv-unfinished"
}

# --- 5: build
# What catkin reads; a change in a .py needs no build, a new package or a changed .msg does.
build_inputs() {
  echo "$root"
  (cd "$root" && find src -name __pycache__ -prune -o -type f \( -name package.xml -o -name CMakeLists.txt -o -name setup.py \
    -o -name '*.msg' -o -name '*.srv' -o -name '*.action' -o -name '*.cmake' -o -name '*.in' -o -name '*.c' -o -name '*.cpp' \
    -o -name '*.h' -o -name '*.hpp' -o -name CATKIN_IGNORE -o -path '*/env-hooks/*' \) -print0 | sort -z | xargs -0 -r sha256sum
    find src -name __init__.py | sort)
}
build_workspace() {
  local told
  told=$(python3 "$root/scripts/own_packages.py" "$root/src") || exit 1
  build_inputs >"$state/build-inputs.now"
  if [ "$force_build" = no ] && [ -f "$root/devel/setup.bash" ] && [ ! -e "$state/build-unfinished" ] &&
    cmp -s "$state/build-inputs.now" "$state/build-inputs"; then return 0; fi
  step 5 "building the workspace"
  [ -z "$told" ] || say "$told"
  # Left-overs of an interrupted build, of another folder or of a package that is gone would be taken for good.
  # CMake sets the modes of its files, which only their owner may: in a container that is the image's maker.
  if [ -e "$state/build-unfinished" ] || [ ! -O "$root/build" ] || ! same_packages; then rm -rf "$root/build" "$root/devel"; fi
  touch "$state/build-unfinished"
  mkdir -p "$root/devel/lib/python3/dist-packages"  # else catkin leaves it out of the PYTHONPATH it remembers
  # The venv's python, since catkin writes it into the wrappers of installed scripts.
  cd "$root"
  # By our catkin_make, which leaves out a learner's package that asks for what nobody has.
  PYTHONPATH=src/workspace_needs/src ROS_PACKAGE_PATH=src:/usr/share logged build \
    python3 src/workspace_needs/scripts/catkin_make --no-color -DPYTHON_EXECUTABLE="$venv/bin/python3" ||
    fail_with_cause "catkin_make failed"
  grep -a ' is left out: ' "$state/build.log" || true
  if [ -d src/navigation/nav_algorithms ] && [ ! -e src/navigation/CATKIN_IGNORE ]; then
    PYTHONPATH=src/navigation/nav_algorithms/src logged compile "$venv/bin/python3" -m nav_algorithms.warm_up ||
      fail_with_log "compiling the inner loops of navigation failed" compile
  fi
  mv "$state/build-inputs.now" "$state/build-inputs"
  rm -f "$state/build-unfinished"
}
same_packages() {
  [ -f "$state/build-inputs" ] && diff -q <(packages_in "$state/build-inputs") <(packages_in "$state/build-inputs.now") >/dev/null
}
packages_in() { head -1 "$1"; awk '/package.xml$/ {print $2}' "$1"; }

check_machine
mkdir -p "$state"
exec 9<"$root"  # two setups at once would trip over each other
flock -n 9 || { say "Another setup is running in this folder: waiting for it."; flock 9; }
mapfile -t missing < <(missing_packages)
if [ ${#missing[@]} -gt 0 ] || ! venv_is_sound; then
  step 1 "checking this machine"
  [ ${#missing[@]} -eq 0 ] || check_rights
  check_disk $((debian_mb * ${#missing[@]} / $(wanted_packages | wc -l))) \
    $((build_mb + $(venv_is_sound && echo 0 || echo "$python_mb")))
fi
debian_packages
python_environment
python_packages
[ "$build" = no ] || build_workspace
[ "$did" = yes ] && say "Set up in ${SECONDS} s." || say "Nothing to set up."
