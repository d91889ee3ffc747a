#!/usr/bin/env bash
# Compares all lane detection methods on the same seeds: table and chart in out/bench_lanes/.
#
#   scripts/bench_lanes.sh [--seeds N] [--methods NAME ...] [--out DIR] [--resume] [--workers N | --scheduler ADDRESS]
#
# Exit code 0: all methods were run, whatever the results; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/bench_lanes.py" "$@"
