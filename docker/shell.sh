#!/usr/bin/env bash
# A terminal beside the world that runs, with one line about it.
if timeout 10 rosservice list 2>/dev/null | grep -q '^/gazebo/'; then
  echo "A world is running; its page is http://localhost:${PORT:-8080}. Type a lesson's rosrun or rostopic here."
else
  echo "No world runs yet: type a roslaunch here, or in another terminal of your machine:" \
    "docker compose -f docker/compose.yaml up viewer"
fi
exec bash
