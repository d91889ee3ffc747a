# Step 1: what setup finds and cannot change.

served="Debian 12 and 13"
builds_only_for="amd64 and arm64 (64-bit Intel, AMD or ARM)"

# Sets platform, such as bookworm-amd64, and lists, the folder of its lists of packages.
check_machine() {
  local id='' codename='' name='' architecture
  [ -r /etc/os-release ] && eval "$(. /etc/os-release; printf 'id=%q codename=%q name=%q' "${ID:-}" "${VERSION_CODENAME:-}" "${PRETTY_NAME:-}")"
  compgen -G "$root/dependencies/${codename:-none}-*" >/dev/null && [ "$id" = debian ] ||
    fail "this is ${name:-no Debian}, and the ROS packages used here are those of $served: use one of these, or docker/ in this repository"
  architecture=$(dpkg --print-architecture)
  platform=$codename-$architecture lists=$root/dependencies/$codename-$architecture
  [ -d "$lists" ] ||
    fail "this is a machine of architecture $architecture, and Numba, ONNX Runtime and OpenCV are built for $builds_only_for only"
  case "$root" in
    *[[:space:]:\;\"\'\$\&\#\(\)\\]*)
      fail "the folder's name \"$root\" has a blank or one of : ; \" ' \$ & # ( ) \\, which catkin cannot take: move the folder" ;;
  esac
  [ -w "$root" ] || fail "$(id -un) may not write in $root: run as its owner, $(stat -c %U "$root")"
}

free_mb() { df -Pm "$1" 2>/dev/null | awk 'NR==2 {print $4}'; }
check_disk() {  # MB that Debian's packages need below /usr, MB that this folder needs
  local system=$1 here=$2 free
  if [ "$(stat -c %d /usr)" = "$(stat -c %d "$root")" ]; then here=$((here + system)) system=0; fi
  free=$(free_mb /usr)
  [ "${free:-$system}" -ge "$system" ] || fail "too little disk: /usr has $free MB free, $system MB are needed"
  free=$(free_mb "$root")
  [ "${free:-$here}" -ge "$here" ] || fail "too little disk: $root has $free MB free, $here MB are needed"
}

check_rights() {
  [ "$(id -u)" != 0 ] || return 0
  local how="run \`make setup\` once as root, or as a user who may use sudo"
  command -v sudo >/dev/null || fail "Debian packages are missing, you are not root and there is no sudo: $how"
  if [ -t 0 ]; then sudo -v; else sudo -n true 2>/dev/null; fi ||
    fail "Debian packages are missing, you are not root and sudo refused $(id -un): $how"
}
