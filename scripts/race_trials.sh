#!/usr/bin/env bash
# Many laps of the racecar, each with its own start, camera noise and light: out/race_trials/.
#
#   scripts/race_trials.sh [--seeds N] [--first-seed N] [--tracks N] [--first-track N]
#                          [--followers FILE ...] [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: all laps of the first follower completed within the limits; 1: some not; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/race_trials.py" "$@"
