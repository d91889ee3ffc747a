#!/usr/bin/env bash
# Starts the line course and the page that shows it in the browser; prints the page's address.
#
#   scripts/viewer.sh [control:=true] [rviz:=FILE] [port:=8080] [address:=0.0.0.0] ...   as in viewer.launch
failure_code=2
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" || exit 2
enter_workspace
arguments=()
for word in "$@"; do
  if [[ $word == rviz:=?* ]]; then
    word=rviz:=$(realpath -m -- "${word#rviz:=}")  # the node runs in another folder
    rosrun sim_viewer rviz_page --check -d "${word#rviz:=}" || exit 2
  fi
  arguments+=("$word")
done
choose_master
mkdir -p "$root/out"
roslaunch learning_topic 0course.launch gui:=false > "$root/out/viewer.log" 2>&1 < /dev/null &
launched=$!
page=
trap 'kill -INT $launched $page 2> /dev/null || true; wait $launched $page || true' EXIT
trap 'exit 130' INT TERM HUP
echo $"The course is starting; its nodes' output is in out/viewer.log. Ctrl-C ends both course and page."
until rosservice list 2> /dev/null | grep -q '^/gazebo/get_world_properties$'; do
  if ! kill -0 "$launched" 2> /dev/null; then
    tail -n 5 "$root/out/viewer.log" >&2
    echo $"viewer: the course did not start; the full output is in out/viewer.log" >&2
    exit 2
  fi
  sleep 0.2
done
# In the background: otherwise this shell would react to a container's SIGTERM only after the page has ended.
roslaunch sim_viewer viewer.launch "${arguments[@]}" &
page=$!
wait "$page"
