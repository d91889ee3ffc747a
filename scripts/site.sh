#!/usr/bin/env bash
# Builds out/site/: all pages in English and Chinese, with a search; the replay in it is the last course's, or is driven now.
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --site || exit 2
enter_workspace
[ -f "$root/out/course/run.html" ] || { say $"The site shows a replay: driving a lap for it."; "$root/scripts/course.sh" --fast || exit 2; }
exec python3 "$root/tools/site" "$@"
