#!/usr/bin/env bash
# Laps of the lane in varying light, then encounters with people crossing: out/lane_trials/.
#
#   scripts/lane_trials.sh [--seeds N] [--crossings N] [--method NAME] [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: all results are within the limits; 1: some are not; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/lane_trials.py" "$@"
