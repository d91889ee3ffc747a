#!/usr/bin/env bash
# Drives the missions of AutoRace 2020 with the lessons of learning_autorace: out/autorace/.
#
#   scripts/autorace.sh [--seeds N] [--first-seed N] [--mission NAME] [--out DIR] [--resume]
#                       [--workers N | --scheduler ADDRESS]
#
# Exit code 0: every mission passed in every drive; 1: some failed; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/autorace.py" "$@"
