# Part of step 4: builds packages without a wheel for this platform from source, once for all clones of a user.

build_minutes=$"about 5 minutes on two idle cores"
build_needs_mb=900  # measured: source 430, build 250, wheel 150
# The same on each release: Debian 13's setuptools uses these alone, Debian 12's adds them to Python's own.
build_flags="-O2 -g0 -DNDEBUG -fno-strict-overflow"
c_flags="$build_flags -Wno-error=incompatible-pointer-types"  # an error since GCC 14, which PyBullet 3.2.7's code causes

source_packages() {
  local list=$lists/requirements-source.txt names cache wheels
  cache=$(cache_folder)
  names=$(awk -F == '/^[A-Za-z]/ {split($2, version, " "); print $1, version[1]}' "$list" | paste -sd , | sed 's/,/, /g')
  wheels=$cache/ros1-driving-courses/wheels/$(wheels_key "$list")
  chmod go-w "$cache/ros1-driving-courses" "${wheels%/*}" 2>/dev/null || true
  if whole "$wheels"; then
    step 4 $"installing $names as built before ($wheels)"
  else
    step 4 $"building $names from source, because there is no wheel ($build_minutes)"
    build_wheels "$list" "$names"
    keep_wheels "$wheels" || wheels=$state/wheels
  fi
  logged pip pip install --no-user --no-index --force-reinstall "$wheels"/*.whl || pip_failed install
  rm -rf "$state/wheels"
}
# The user's cache; a relative XDG_CACHE_HOME is ignored. Without a home the wheels stay in this clone.
cache_folder() {
  case "${XDG_CACHE_HOME:-}" in /*) echo "$XDG_CACHE_HOME"; return ;; esac
  case "${HOME:-}" in /*) echo "$HOME/.cache" ;; *) echo "$state/cache" ;; esac
}
# A hash of what a wheel depends on: the source, compiler flags, release, and the NumPy whose headers it is compiled with.
wheels_key() {
  { echo "$platform $c_flags"; cat "$1"; grep -A 1 '^numpy==' "$lists/requirements.txt"; } | sha256sum | cut -c 1-16
}
# Whether a folder has all that was built and nothing else, is this user's, and is writable by nobody else.
whole() {
  [ -z "$(find "${1%/*}" -maxdepth 0 \( ! -user "$(id -u)" -o -perm /022 \) 2>&1)" ] &&
    [ -z "$(find "$1" \( ! -user "$(id -u)" -o -perm /022 -o -type l \) 2>&1)" ] &&
    (cd "$1" && cmp -s <(printf '%s\n' *.whl) <(cut -c 67- SHA256SUMS) && sha256sum --status -c SHA256SUMS) 2>/dev/null
}
# Without pip's cache, which may hold a wheel built with other flags.
build_wheels() {
  local made=$state/wheel-build free
  free=$(free_mb "$root")
  [ "${free:-$build_needs_mb}" -ge "$build_needs_mb" ] ||
    fail $"not enough disk space: $root has $free MB free, building $2 needs $build_needs_mb MB"
  rm -rf "$made" "$state/wheels"
  mkdir -p "$made"
  doing=$"building $2 ($build_minutes)" TMPDIR=$made CFLAGS=$c_flags CXXFLAGS=$build_flags logged pip \
    pip wheel --no-cache-dir --no-build-isolation --no-binary :all: --require-hashes -r "$1" -w "$state/wheels" || pip_failed wheel
  (cd "$state/wheels" && sha256sum -- *.whl >SHA256SUMS)
  rm -rf "$made"
}
# The folder appears complete or not at all, even if two clones build at once; one kept by another clone meanwhile stays.
keep_wheels() {
  local part=$1.$$ above=${1%/*}
  if mkdir -p "$above" 2>/dev/null && chmod go-w "${above%/*}" "$above" 2>/dev/null &&
    { whole "$1" || { cp -r "$state/wheels" "$part" 2>/dev/null && chmod -R go-w "$part" && whole "$part" &&
      rm -rf "$1" 2>/dev/null && mv -T "$part" "$1" 2>/dev/null; }; }; then return 0; fi
  rm -rf "$part"
  say $"  The built wheel cannot be kept in ${1%/*}: another clone will build it again."
  return 1
}
