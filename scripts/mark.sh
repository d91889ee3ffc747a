#!/usr/bin/env bash
# Marks a folder of submissions, each of which drives in a sandbox: out/mark/marks.csv, marks.html.
#
#   scripts/mark.sh --submissions DIR [--course course|race|lane] [--seeds N] [--rules YAML] [--no-sandbox]
#                   [--film] [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: every case could be run; 1: some could not; 2: nothing could.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/marking/scripts/mark.py" "$@"
