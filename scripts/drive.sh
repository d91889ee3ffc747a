#!/usr/bin/env bash
# The racecar, driven by keyboard: in a window if there is a screen, else in this terminal.
failure_code=2
trap 'exit 0' INT  # Ctrl-C is how it is meant to end: make has nothing to report
here=$(dirname "${BASH_SOURCE[0]}")  # a command of its own, after which Ctrl-C counts
. "$here/common.sh"
"$root/scripts/setup.sh" || exit 2
enter_workspace
end_with_terminal
choose_master || exit 1
set -- ackermann:=true command_timeout:=true "$@"
if [ -n "${DISPLAY:-}" ]; then
  wait_for_simulator $$ &  # which roslaunch becomes
  exec roslaunch racecar_description car_control.launch "$@" {turn}>&-
fi
if ! [ -t 0 ]; then
  echo $"drive: there is no screen (DISPLAY) and no terminal to read keys from; run it in a terminal" >&2
  exit 2
fi
mkdir -p "$root/out"
roslaunch racecar_description car_control.launch gui:=false keyboard:=false "$@" \
  > "$root/out/drive.log" 2>&1 < /dev/null {turn}>&- &
launched=$!
# SIGTERM, as one in the background ignores SIGINT at first
trap 'kill "$launched" 2> /dev/null || true; wait "$launched" || true' EXIT
trap 'exit 130' TERM HUP
echo $"The car is starting; the nodes' output is in out/drive.log."
if ! wait_for_simulator "$launched"; then
  tail -n 5 "$root/out/drive.log" >&2
  echo $"drive: the car did not start; the full output is in out/drive.log" >&2
  exit 2
fi
rosrun car_control keyboard_control.py --terminal
