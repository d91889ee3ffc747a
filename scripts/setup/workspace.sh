# Step 5: the build.
# Hashes of what catkin reads: a new package or a changed .msg needs a build, a changed .py does not, except makers. build/ is made by `pip install ./src/...`.
build_inputs() {
  echo "$root"
  (cd "$root" && find src tools \( -name __pycache__ -o -name build \) -prune -o -type f \( -name package.xml -o -name CMakeLists.txt -o -name setup.py \
    -o -name '*.msg' -o -name '*.srv' -o -name '*.action' -o -name '*.cmake' -o -name '*.in' -o -name '*.c' -o -name '*.cpp' \
    -o -name '*.h' -o -name '*.hpp' -o -name CATKIN_IGNORE -o -path '*/env-hooks/*' -o -path 'tools/*.py' \) -print0 | sort -z | xargs -0 -r sha256sum
    find src -name build -prune -o -name __init__.py -print | sort)
}
build_workspace() {
  local told
  (
    trap '' INT  # each would print a traceback; this shell ends after it
    python3 "$root/src/sim/bullet_sim/src/bullet_sim/props.py"  # as the build does; takes 0.1 s
    [ ! -d "$root/tools/makers" ] || "$venv/bin/python3" -B "$root/tools/makers" name_packages >/dev/null || exit 1
    [ ! -d "$root/src/compat/turtlebot3_gazebo" ] || "$venv/bin/python3" -B "$root/tools/makers" turtlebot3_worlds >/dev/null || exit 1  # 0.1 s unless something has changed
  )
  told=$(trap '' INT; python3 "$root/scripts/own_packages.py" "$root/src" 2>&1 | translated) || { printf '%s\n' "$told" >&2; exit 1; }
  if grep -qs '^CPP_LESSONS:BOOL=ON' "$root/build/CMakeCache.txt"; then cpp=ON  # built once, so keep them up to date
  elif [ "$cpp" = ON ]; then force_build=yes; fi
  rm -f "$state/build-inputs.now"  # owned by root if make was once run with sudo
  build_inputs >"$state/build-inputs.now"
  if [ "$force_build" = no ] && [ -f "$root/devel/setup.bash" ] && [ ! -e "$state/build-unfinished" ] &&
    cmp -s "$state/build-inputs.now" "$state/build-inputs"; then return 0; fi
  step 5 $"building the workspace"
  [ -z "$told" ] || say "$told"
  # Left-overs of an interrupted build, another folder or a removed package would be used as if valid.
  # CMake sets its files' modes, which only their owner may do: in a container that is who built the image.
  if [ -e "$state/build-unfinished" ] || [ ! -O "$root/build" ] || ! same_packages; then rm -rf "$root/build" "$root/devel"; fi
  touch "$state/build-unfinished"
  mkdir -p "$root/devel/lib/python3/dist-packages"  # else catkin omits it from the PYTHONPATH it stores
  # The venv's python, because catkin writes it into the wrappers of installed scripts; Debian 13's reads the second name.
  cd "$root"
  # With our catkin_make, which leaves out learners' packages whose dependencies are not available; messages for C++ and Python only.
  ROS_LANG_DISABLE=genlisp PYTHONPATH=src/workspace_needs/src ROS_PACKAGE_PATH=src:/usr/share logged build \
    python3 src/workspace_needs/scripts/catkin_make --no-color "-DPYTHON_EXECUTABLE=$venv/bin/python3" "-DPython_EXECUTABLE=$venv/bin/python3" \
    "-DCPP_LESSONS:BOOL=$cpp" ||
    fail_with_cause $"catkin_make failed"
  grep -a ' is left out: ' "$state/build.log" | awk '!said[$0]++' | translated || true
  [ "$cpp" = ON ] || cpp_stand_ins
  if [ -d src/navigation/nav_algorithms ] && [ ! -e src/navigation/CATKIN_IGNORE ]; then
    PYTHONPATH=src/navigation/nav_algorithms/src logged compile "$venv/bin/python3" -m nav_algorithms.warm_up ||
      fail_with_log $"compiling the inner loops of navigation failed" compile
  fi
  refuse_other_terminals
  mv "$state/build-inputs.now" "$state/build-inputs"
  rm -f "$state/build-unfinished"
}
# Sourced outside of the Debian in which it was built, devel/setup.bash says what to type instead.
refuse_other_terminals() {
  [ -e /etc/ros1-driving-courses ] || return 0
  sed -i "1i [ -e /etc/ros1-driving-courses ] || { '$root/scripts/help.sh' --no-ros; return 1; }" "$root/devel/setup.bash"
}
# What rosrun finds where the lessons' C++ programs are not built: a line that says how to build them.
cpp_stand_ins() {
  local file package program
  for file in "$root"/src/learning_topic/src/*.cpp "$root"/src/lessons/*/*/*.cpp; do
    package=$(basename "$(dirname "$(dirname "$file")")") program=$(basename "$file" .cpp)
    if [ ! -d "$root/devel/share/$package" ] || [ -e "$root/devel/lib/$package/$program" ] || ! grep -q 'int main(' "$file"; then continue; fi
    mkdir -p "$root/devel/lib/$package"
    printf '#!/bin/sh\necho "%s %s is in C++ and not built yet; type: make -C %s build CPP=1" | { %s || cat; } >&2\nexit 1\n' \
      "$package" "$program" "$root" "python3 -m terminal_language 2>/dev/null" >"$root/devel/lib/$package/$program"
    chmod +x "$root/devel/lib/$package/$program"
  done
}
same_packages() {
  [ -f "$state/build-inputs" ] && diff -q <(packages_in "$state/build-inputs") <(packages_in "$state/build-inputs.now") >/dev/null
}
packages_in() { head -1 "$1"; awk '/package.xml$/ {print $2}' "$1"; }
# What makes each new terminal one of this workspace; of several clones the last one that asked for it.
bashrc_mark="# ros1-driving-courses"
# In a Debian of its own (debian_root.sh) ROS is not there for the machine's terminals: a word enters one in there.
terminal_line() { [ -e /etc/ros1-driving-courses ] && echo "make -sC $root shell" || echo "source $root/devel/setup.bash"; }
bashrc_line() {
  local line
  line=$(terminal_line)
  [[ $line != make* ]] || line="alias courses='$line'"
  printf '%s' "$line  $bashrc_mark"
}
source_in_bashrc() {
  local file=${HOME:-}/.bashrc line
  line=$(bashrc_line) line=${line%  "$bashrc_mark"}
  if grep -qsxF "$(bashrc_line)" "$file"; then say $"$file has this line already: $line"; return; fi
  if [ -e "$file" ] && { [ ! -w "$file" ] || ! sed -i --follow-symlinks "/$bashrc_mark\$/d" "$file" 2>/dev/null; }; then
    fail $"$file cannot be written: type in each new terminal: $line"
  fi
  { [ ! -s "$file" ] || [ -z "$(tail -c 1 "$file")" ] || echo; bashrc_line; echo; } 2>/dev/null >>"$file" || fail $"$file cannot be written: type in each new terminal: $line"
  say $"Written into $file: $line. It holds for each new terminal."
}
