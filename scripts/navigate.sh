#!/usr/bin/env bash
# Mapping and navigation in the house, without a screen: writes out/navigate/.
#
#   scripts/navigate.sh [--goals N] [--seed N] [--real-time-factor X] [--map YAML] [--house NAME] [--out DIR]
#
# Exit code 0: all goals reached without contact, map and localisation within their limits; 1: not so; 2: it could not run.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" || exit 2
enter_workspace
exec python3 "$root/src/evaluation/scripts/navigate.py" "$@"
