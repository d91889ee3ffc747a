#!/usr/bin/env bash
# Compares our lists of Debian packages with another release's: check_releases.py.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --dependencies
exec "$root/.venv/bin/python" "$root/scripts/check_releases.py" "$@"
