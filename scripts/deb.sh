#!/usr/bin/env bash
# Builds one Debian package of everything: out/ros-courses_VERSION_ARCHITECTURE.deb. docs/installed.md lists its contents.
#
# Always a clean build, in .setup/deb: files left by an older build would be packed too.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
"$root/scripts/setup.sh" --dependencies

prefix=/opt/ros/courses build=$root/.setup/deb logs=$root/.setup python=$root/.venv/bin/python3
step() {  # name of the log, what to say, command
  local log=$logs/deb-$1.log
  say "$2 (after ${SECONDS} s)"
  shift 2
  "$@" >"$log" 2>&1 </dev/null || fail "$(grep -m1 -E '^CMake Error|[Ee]rror:' "$log" || tail -n 1 "$log") (full log: ${log#"$root"/})"
}

rm -rf "$build"
step configure "Configuring for $prefix" cmake -S "$root/src" -B "$build" -DCMAKE_INSTALL_PREFIX="$prefix" \
  -DCATKIN_DEVEL_PREFIX="$build/devel" -DCATKIN_ENABLE_TESTING=OFF "-DPYTHON_EXECUTABLE=$python" "-DPython_EXECUTABLE=$python" -DCPP_LESSONS=OFF
step build "Building" cmake --build "$build" --parallel "$(nproc)"
DESTDIR=$build/stage step install "Installing into .setup/deb/stage" cmake --install "$build"
step stage "Adding the Python packages" "$python" "$root/scripts/deb_stage.py" "$build/stage" "$prefix"
file=$("$python" "$root/scripts/deb_control.py" "$build/stage" "$prefix")
mkdir -p "$root/out"
SOURCE_DATE_EPOCH=$(stat -c %Y "$build/stage/DEBIAN/control") step pack "Packing" \
  dpkg-deb --root-owner-group -Zzstd -z10 --build "$build/stage" "$root/out/$file"
rm -rf "$build"
size=$(($(stat -c %s "$root/out/$file") / 1000000))
say $"out/$file: $size MB, made in ${SECONDS} s. Next: sudo apt install ./out/$file"
