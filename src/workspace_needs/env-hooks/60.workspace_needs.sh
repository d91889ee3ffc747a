# Sourced by setup.*sh, after the workspace's Python is on the PATH: once a user, rosdep's cache.
if [ ! -e "${ROS_HOME:-$HOME/.ros}/rosdep/sources.cache" ]; then
  python3 -m workspace_needs.cache >/dev/null 2>&1 || true
fi
