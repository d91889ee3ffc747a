# Step 1: checks what setup cannot change.

builds_only_for=$"amd64 and arm64 (64-bit Intel, AMD or ARM)"

# Sets `platform`, such as bookworm-amd64, and `lists`, the folder with its package lists.
check_machine() {
  local codename architecture
  codename=$(. /etc/os-release; echo "$VERSION_CODENAME")  # one of dependencies/: common.sh
  architecture=$(dpkg --print-architecture)
  platform=$codename-$architecture lists=$root/dependencies/$codename-$architecture
  [ -d "$lists" ] ||
    fail $"this machine's architecture is $architecture, but Numba, ONNX Runtime and OpenCV are built for $builds_only_for only"
  check_folder
  [ -w "$root" ] || { owner=$(stat -c %U "$root"); fail $"you ($(id -un)) may not write to $root: run this as its owner, $owner"; }
}

check_folder() {
  case "$root" in
    *[[:space:]:\;\"\'\$\&\#\(\)\\]*)
      fail $"the folder's name \"$root\" has a space or one of : ; \" ' \$ & # ( ) \\, which catkin cannot handle: move the folder" ;;
  esac
}

free_mb() { df -Pm "$1" 2>/dev/null | awk 'NR==2 {print $4}'; }
check_disk() {  # MB needed in /usr for Debian's packages, MB needed in this folder
  local system=$1 here=$2 free
  if [ "$(stat -c %d /usr)" = "$(stat -c %d "$root")" ]; then here=$((here + system)) system=0; fi
  free=$(free_mb /usr)
  [ "${free:-$system}" -ge "$system" ] || fail $"not enough disk space: /usr has $free MB free, $system MB are needed"
  free=$(free_mb "$root")
  [ "${free:-$here}" -ge "$here" ] || fail $"not enough disk space: $root has $free MB free, $here MB are needed"
}

check_rights() {
  [ "$(id -u)" != 0 ] || return 0
  local how=$"run \`make setup\` once as root, or as a user who may use sudo"
  command -v sudo >/dev/null || fail $"Debian packages are missing, you are not root and there is no sudo: $how"
  if [ -t 0 ]; then sudo -v; else sudo -n true 2>/dev/null; fi ||
    fail $"Debian packages are missing, you are not root and sudo refused $(id -un): $how"
}
