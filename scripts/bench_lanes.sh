#!/usr/bin/env bash
# All methods that find the lane, on the same seeds: table and chart in out/bench_lanes/.
#
#   scripts/bench_lanes.sh [--seeds N] [--methods NAME ...] [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: all were driven, however they drove; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/bench_lanes.py" "$@"
