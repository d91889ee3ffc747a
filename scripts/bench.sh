#!/usr/bin/env bash
# Measures: sets up what is missing, then writes out/bench/bench.json and bench.png.
#
#   scripts/bench.sh [--only PART,...] [--quick] [--memory-s S] [--out DIR]
#
# Exit code 0: all was measured; 2: something could not be. Whether a figure is good decides nothing.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --learning || exit 2
enter_workspace
exec python3 "$root/src/sim/sim_bench/scripts/bench.py" "$@"
