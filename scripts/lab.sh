#!/usr/bin/env bash
# Lessons, editor, terminals and the world in one browser window, at an address with a token, on this machine only.
#
#   scripts/lab.sh [--ws ~/courses_ws] [--port 8888]   Ctrl-C ends it; exit code 2: it could not start
failure_code=2
here=$(dirname "${BASH_SOURCE[0]}")
. "$here/common.sh"
words=("$@")
for at in "${!words[@]}"; do
  value=${words[at + 1]:-}
  [ "${words[at]}" != --port ] || [[ $value =~ ^[0-9]{4,5}$ && 10#$value -ge 1024 && 10#$value -le 65535 ]] ||
    fail $"port is $value; give one from 1024 to 65535, such as PORT=8889"
done
"$root/scripts/setup.sh" --lab || exit 2
enter_workspace
end_with_terminal
exec python3 "$root/tools/lab" "$@"
