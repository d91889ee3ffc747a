# Sourced by devel/setup.*sh: the workspace's Python comes first, and the tutorials' robot is the waffle.
_bullet_sim_bin="${CATKIN_ENV_HOOK_WORKSPACE%/*}/.venv/bin"
if [ -x "$_bullet_sim_bin/python3" ]; then
  _bullet_sim_path=":$PATH:"
  while :; do
    case "$_bullet_sim_path" in
      *":$_bullet_sim_bin:"*)
        _bullet_sim_path="${_bullet_sim_path%%":$_bullet_sim_bin:"*}:${_bullet_sim_path#*":$_bullet_sim_bin:"}" ;;
      *) break ;;
    esac
  done
  _bullet_sim_path="${_bullet_sim_path#:}"
  export PATH="$_bullet_sim_bin:${_bullet_sim_path%:}"
  unset _bullet_sim_path
fi
unset _bullet_sim_bin
export TURTLEBOT3_MODEL="${TURTLEBOT3_MODEL:-waffle}"
