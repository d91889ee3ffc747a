#!/usr/bin/env bash
# Starts the line course and the page that shows it in the browser; prints the page's address.
#
#   scripts/viewer.sh [control:=true] [rviz:=FILE] [port:=8080] [address:=0.0.0.0] ...   as in viewer.launch
failure_code=2
trap 'exit 0' INT  # Ctrl-C is how it is meant to end: make has nothing to report
here=$(dirname "${BASH_SOURCE[0]}")  # a command of its own, after which Ctrl-C counts
. "$here/common.sh"
# Begun in the background of a script, a shell ignores Ctrl-C and cannot trap it; what it starts does not ignore it.
[[ $(trap -p INT) == *exit* ]] || exec env --default-signal=INT bash "$0" "$@"
for word in "$@"; do
  if [[ $word == port:=* ]] && ! [[ ${word#port:=} =~ ^[1-9][0-9]{0,4}$ && ${word#port:=} -le 65535 ]]; then
    fail $"port is ${word#port:=}; give one from 1 to 65535, such as PORT=8080"
  fi
done
"$root/scripts/setup.sh" || exit 2
enter_workspace
end_with_terminal
arguments=()
for word in "$@"; do
  if [[ $word == rviz:=?* ]]; then
    word=rviz:=$(realpath -m -- "${word#rviz:=}")  # the node runs in another folder
    rosrun sim_viewer rviz_page --check -d "${word#rviz:=}" || exit 2
  fi
  arguments+=("$word")
done
page_line() { trap '' INT; python3 -m sim_viewer.running_page "${arguments[@]/#/_}"; }
# What a log says went wrong, three lines of it at most; fails if there is none.
reasons() { grep -a 'runs already\|has died\|FATAL\|ERROR\|Exception' "$1" | tail -n 3 | grep . >&2; }
if ! choose_master; then
  page=$(page_line)
  [ -n "$page" ] || page=$"To see it in the browser, type: source devel/setup.bash; roslaunch sim_viewer viewer.launch"
  say "$page"
  exit 1
fi
mkdir -p "$root/out"
# Each ends with this shell, also one that is killed. By SIGTERM, as one in the background ignores SIGINT at first.
setpriv --pdeathsig TERM roslaunch learning_topic 0course.launch gui:=false > "$root/out/viewer.log" 2>&1 < /dev/null {turn}>&- &
launched=$!
page=
trap 'kill $launched $page 2> /dev/null || true; wait $launched $page || true' EXIT
trap 'exit 130' TERM HUP
say $"The course is starting; its nodes' output is in out/viewer.log. Ctrl-C ends both course and page."
if ! wait_for_simulator "$launched"; then
  reasons "$root/out/viewer.log" || tail -n 5 "$root/out/viewer.log" >&2
  echo $"viewer: the course did not start; the full output is in out/viewer.log" >&2
  exit 2
fi
running=$(page_line)
if [ -n "$running" ]; then
  say "$running"
  wait "$launched" || true
else
  # In the background: otherwise this shell would react to a container's SIGTERM only after the page has ended.
  setpriv --pdeathsig TERM roslaunch sim_viewer viewer.launch "${arguments[@]}" &
  page=$!
  wait -n "$launched" "$page" || true
  kill -0 "$launched" 2> /dev/null && exit 1  # the page has said why it ended
fi
reasons "$root/out/viewer.log" || true
echo $"viewer: the course has ended, and with it the page; the full output is in out/viewer.log" >&2
exit 1
