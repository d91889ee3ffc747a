# Puts this workspace's bin folder first on PATH, once: the Python environment, which comes before
# it otherwise, has an xacro command of its own that cannot answer $(find package).
_xacro_bin="$CATKIN_ENV_HOOK_WORKSPACE/bin"
_xacro_path=":$PATH:"
while [ "${_xacro_path#*:"$_xacro_bin":}" != "$_xacro_path" ]; do
  _xacro_path="${_xacro_path%%:"$_xacro_bin":*}:${_xacro_path#*:"$_xacro_bin":}"
done
_xacro_path="${_xacro_path#:}"
PATH="$_xacro_bin:${_xacro_path%:}"
export PATH
unset _xacro_bin _xacro_path
