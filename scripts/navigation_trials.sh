#!/usr/bin/env bash
# Tests move_base in many narrow yards, and with people crossing its path: out/navigation_trials/.
#
#   scripts/navigation_trials.sh [--yards N] [--first-yard N] [--repeats N] [--crossings N]
#                                [--first-crossing N] [--real-time-factor X] [--parameters FILE]
#                                [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: at least 95 % of the yards crossed and nobody touched; 1: not so; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/navigation_trials.py" "$@"
