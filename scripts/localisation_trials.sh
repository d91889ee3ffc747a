#!/usr/bin/env bash
# Tests amcl in the house: global localisation, kidnapped robot, tracking, and CPU load: out/localisation_trials/.
#
#   scripts/localisation_trials.sh [--starts N] [--kidnaps N] [--first N] [--tracking S] [--load S]
#                                  [--wheel-odometry] [--seed N] [--real-time-factor X] [--out DIR]
#                                  [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: all results are within the limits; 1: some are not; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/localisation_trials.py" "$@"
