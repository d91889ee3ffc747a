#!/usr/bin/env bash
# Checks the style of all Python code against the rules in pyproject.toml.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --tests --dependencies
cd "$root"
exec .venv/bin/ruff check "$@"
