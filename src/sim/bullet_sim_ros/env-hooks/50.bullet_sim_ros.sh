# Sourced by devel/setup.*sh: the workspace's Python before the system's, and the tutorials' robot.
# The Python environment stands behind this workspace's bin folder, whose xacro answers
# $(find package), and so behind those of workspaces on top of it: a learner's programs win.
_bullet_sim_bin="${CATKIN_ENV_HOOK_WORKSPACE%/*}/.venv/bin"
if [ -x "$_bullet_sim_bin/python3" ]; then
  _bullet_sim_path=":$PATH:"
  while [ "${_bullet_sim_path#*:"$_bullet_sim_bin":}" != "$_bullet_sim_path" ]; do
    _bullet_sim_path="${_bullet_sim_path%%:"$_bullet_sim_bin":*}:${_bullet_sim_path#*:"$_bullet_sim_bin":}"
  done
  _bullet_sim_own=":$CATKIN_ENV_HOOK_WORKSPACE/bin:"
  case "$_bullet_sim_path" in
    *"$_bullet_sim_own"*)
      _bullet_sim_path="${_bullet_sim_path%%"$_bullet_sim_own"*}$_bullet_sim_own$_bullet_sim_bin:${_bullet_sim_path#*"$_bullet_sim_own"}" ;;
    *) _bullet_sim_path=":$_bullet_sim_bin$_bullet_sim_path" ;;
  esac
  _bullet_sim_path="${_bullet_sim_path#:}"
  export PATH="${_bullet_sim_path%:}"
  unset _bullet_sim_path _bullet_sim_own
fi
unset _bullet_sim_bin
export TURTLEBOT3_MODEL="${TURTLEBOT3_MODEL:-waffle}"
# Images are taken apart and put together in pieces of some MB. The C library gives each back to the
# system and asks for it again; for lesson 05 in lockstep that was a quarter of the time (measured).
export MALLOC_MMAP_THRESHOLD_="${MALLOC_MMAP_THRESHOLD_:-33554432}"
export MALLOC_TRIM_THRESHOLD_="${MALLOC_TRIM_THRESHOLD_:-67108864}"
