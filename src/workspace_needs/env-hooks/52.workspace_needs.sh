# Sourced by each setup.*sh on top of this workspace: a package there hides the courses' one of its name.
_courses_others=":$ROS_PACKAGE_PATH:"
_courses_others="${_courses_others%%":${CATKIN_ENV_HOOK_WORKSPACE%/*}/src:"*}"
_courses_others="${_courses_others%%":$CATKIN_ENV_HOOK_WORKSPACE/share:"*}"
case "$_courses_others" in *:) _courses_others="" ;; esac  # this workspace is not in the path
_courses_hidden=""
while [ -n "$_courses_others" ]; do
  _courses_others="${_courses_others#:}"
  _courses_found="$(find "${_courses_others%%:*}" -maxdepth 3 -name package.xml 2> /dev/null)"
  while [ -n "$_courses_found" ]; do
    _courses_name="${_courses_found%%/package.xml*}"
    _courses_name="${_courses_name##*/}"
    if [ -e "$CATKIN_ENV_HOOK_WORKSPACE/share/$_courses_name" ]; then
      _courses_hidden="$_courses_hidden $_courses_name"
    fi
    _courses_found="${_courses_found#*/package.xml}"
  done
  _courses_others="${_courses_others#"${_courses_others%%:*}"}"
done
case "$-" in
  *i*) [ -z "$_courses_hidden" ] ||
    eval "python3 -m workspace_needs.hidden '$CATKIN_ENV_HOOK_WORKSPACE/setup.bash' $_courses_hidden" ;;
esac
unset _courses_others _courses_hidden _courses_found _courses_name
