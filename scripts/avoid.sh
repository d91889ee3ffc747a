#!/usr/bin/env bash
# Drives by laser through halls with columns, each generated from its seed: out/avoid/.
#
#   scripts/avoid.sh [--seeds N] [--first-seed N] [--avoider FILE] [--out DIR] [--resume]
#                    [--workers N | --scheduler ADDRESS]
#
# Exit code 0: all goals reached without contact; 1: some not; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
set_up_trial "$@"
enter_workspace
exec python3 "$root/src/evaluation/scripts/avoid.py" "$@"
