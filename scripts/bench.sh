#!/usr/bin/env bash
# Sets up what is missing, runs the benchmarks, and writes out/bench/bench.json and bench.png.
#
#   scripts/bench.sh [--only PART,...] [--quick] [--memory-s S] [--out DIR]
#
# Exit code 0: everything was measured, whatever the results; 2: something could not be measured.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --learning || exit 2
enter_workspace
exec python3 "$root/src/sim_bench/scripts/bench.py" "$@"
