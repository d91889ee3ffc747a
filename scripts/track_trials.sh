#!/usr/bin/env bash
# Follows the red cylinder in many seeded runs: out/track_trials/.
#
#   scripts/track_trials.sh [--seeds N] [--first-seed N] [--sets SET ...] [--out DIR]
#                           [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: enough runs of each set succeeded; 1: not so; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/track_trials.py" "$@"
