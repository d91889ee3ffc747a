#!/usr/bin/env bash
# Marks a folder of submissions, each run in a sandbox: out/mark/marks.csv, marks.html.
#
#   scripts/mark.sh --submissions DIR [--course course|race|lane] [--seeds N] [--rules YAML] [--no-sandbox]
#                   [--film] [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# With sudo it stays root, who may always create a sandbox; with --no-sandbox it does not.
# Exit code 0: every case could be run; 1: some could not; 2: none could.
# scripts/grade.sh is this script for one submission.
failure_code=2 stays_root=yes
case " $* " in *" --no"*) stays_root= ;; esac
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
words=("$@")
for at in "${!words[@]}"; do
  value=${words[at + 1]:-}
  case "${words[at]} $value" in
    "--course course" | "--course race" | "--course lane") ;;
    "--course "*) fail $"--course (COURSE=) must be one of course, race, lane, is '$value'" ;;
  esac
done
set_up_trial "$@"
enter_workspace
end_with_terminal
owner=$(stat -c %u "$root")
[ "$(id -u)" != "$owner" ] || exec python3 "$root/src/marking/scripts/$self.py" "$@"
leave_no_files_of_root() {
  trap '' INT TERM HUP
  kill $(jobs -p) 2> /dev/null || true
  wait
  [ ! -d "$root/out" ] || chown -h --reference="$root" "$root/out"
  [ ! -d "$root/out/$self" ] || chown -Rh --reference="$root" "$root/out/$self"
}
trap leave_no_files_of_root EXIT
trap 'exit 130' INT TERM HUP
PYTHONDONTWRITEBYTECODE=1 python3 "$root/src/marking/scripts/$self.py" "$@" &
wait $!
