#!/usr/bin/env bash
# A Debian for a Linux that is none: made once, by debootstrap, then every script here runs in it, as the user, in the same
# folders, with the same network and screen.
#
#   scripts/debian_root.sh SCRIPT [ARGUMENT...]   runs scripts/SCRIPT in it; makes it first if it is missing
#   scripts/debian_root.sh --remove               removes it, and its rule in /etc/sudoers.d
#   sudo scripts/debian_root.sh --make USER FOLDER...   makes it for this user; FOLDERs are the machine's own in there, too
#
# MIRROR= is as for setup.sh; without it debootstrap chooses.
environment= copy=
if [[ ${1:-} != --* ]]; then  # before common.sh changes it, and where that Debian finds it
  environment=$(umask 077; mktemp /tmp/environment.XXXXXX) && env -0 > "$environment" || exit 2
fi
trap 'rm -rf "$environment" "$copy"' EXIT
trap 'trap - INT; kill -INT $$' INT  # also where what runs has taken Ctrl-C for a fault of its own
on_any_linux=yes stays_root=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
. "$root/scripts/setup/logged.sh"
. "$root/scripts/setup/machine.sh"
. "$root/scripts/setup/mirror.sh"
self=${1%.sh}
place=/var/lib/ros1-driving-courses debian=/var/lib/ros1-driving-courses/debian
rule=/etc/sudoers.d/ros1-driving-courses
release=bookworm
architecture=$(uname -m | sed 's/x86_64/amd64/; s/aarch64/arm64/')  # which a Linux without dpkg cannot tell debootstrap
disk_mb=3300  # measured: 310 of Debian itself, then what setup installs
keyring=/usr/share/keyrings/debian-archive-keyring.gpg

# Whether the Debian is there, complete, and has these folders for this user.
is_ready() {
  local folder
  cmp -s "$root/scripts/setup/enter_debian.sh" "$place/enter" && [ -e "$place/complete" ] || return 1
  for folder in "$@"; do grep -qxF -- "$folder" "$place/folders" || return 1; done
  sudo -n -l "$place/enter" > /dev/null 2>&1
}
# The folders that are the machine's own in there. Of a folder below /home or the like the whole of that is.
folders() {
  local folder
  printf '%s\n' /dev /proc /sys /run /tmp
  for folder in "$root" "${HOME:-/tmp}"; do
    case "$folder" in
      /home/* | /mnt/* | /media/* | /opt/* | /srv/* | /data/*) cut -d / -f 1-2 <<< "$folder" ;;
      /tmp/* | /run/* | /usr/* | /etc/* | /var/lib/ros1-driving-courses* | /) ;;
      *) printf '%s\n' "$folder" ;;
    esac
  done | sort -u
}
by_package_manager() {
  [ "$1" != apt-get ] || apt-get -q update || true
  "$@"
}
install_debootstrap() {
  local how=
  if command -v debootstrap > /dev/null && [ -f "$keyring" ]; then return; fi
  if command -v apt-get > /dev/null; then how='apt-get -q -y install debootstrap debian-archive-keyring'
  elif command -v dnf > /dev/null; then how='dnf -q -y install debootstrap debian-keyring'
  elif command -v pacman > /dev/null; then how='pacman -S --noconfirm --needed debootstrap debian-archive-keyring'
  elif command -v zypper > /dev/null; then how='zypper -n install debootstrap debian-archive-keyring'
  else fail $"install debootstrap and debian-archive-keyring by this Linux's own package manager, then type this again"; fi
  logged debootstrap-install by_package_manager $how || explain $"this failed: $how" debootstrap-install
  [ -f "$keyring" ] || fail $"$keyring is missing: install the package debian-archive-keyring, then type this again"
}
# fail, with what to do where there is no network, or the last error line of a log.
explain() {
  local log=$state/$2.log
  ! network_failed "$2" || fail $"the package archive cannot be reached ($log says more): connect, or correct MIRROR=, then type this again"
  fail_with_log "$1" "$2"
}
# Unmount what a debootstrap that was killed has left, by sudo if that is given.
unmount_rest() {
  local mounted
  mounted=$(awk -v at="$debian.new/" 'index($2, at) == 1 {print $2}' /proc/self/mounts | sort -r)
  [ -z "$mounted" ] || "$@" xargs umount <<< "$mounted" || fail $"$debian.new is still in use: end debootstrap, then type this again"
}
make_debian() {
  local user=$1 new=$debian.new free line
  mkdir -p "$place"
  exec 8< "$place"
  flock -n 8 || { say $"Another terminal is making this Debian: waiting for it."; flock 8; }
  if [ ! -e "$place/complete" ]; then
    free=$(df -Pm "$place" | awk 'NR == 2 {print $4}')
    [ "$free" -ge "$disk_mb" ] || fail $"not enough disk space: $place has $free MB free, $disk_mb MB are needed"
    use_mirror "$state" "$release"
    install_debootstrap
    unmount_rest
    rm -rf --one-file-system "$new" "$debian"
    doing=$"debootstrap is still running" logged debootstrap debootstrap --arch="$architecture" --variant=minbase --keyring="$keyring" \
      --include=ca-certificates,git,make,procps,sudo "$release" "$new" ${archive:+"$archive"} ||
      { rm -rf --one-file-system "$new"; explain $"debootstrap could not make a Debian" debootstrap; }
    sed -i "s/\(.*\) $release main/&\n\1 $release-updates main\n\1-security $release-security main/" "$new/etc/apt/sources.list"
    echo $release > "$new/etc/ros1-driving-courses"  # by which setup knows where it is
    mv "$new" "$debian"
  fi
  shift
  printf '%s\n' "$@" > "$place/folders"
  install -m 755 "$root/scripts/setup/enter_debian.sh" "$place/enter"
  line=ALL
  [ "$passwordless" != yes ] || line="NOPASSWD: ALL"
  add_rules "$debian/etc/sudoers.d/ros1-driving-courses" "$user ALL=(ALL) $line"
  add_rules "$rule" "Defaults!$place/enter !use_pty" "$user ALL=(root) NOPASSWD: $place/enter"
  touch "$place/complete"
}
# Lines of a sudoers file, beside those of other users.
add_rules() {
  { cat "$1" 2> /dev/null || true; printf '%s\n' "${@:2}"; } | awk '!seen[$0]++' > "$1.new"
  chmod 440 "$1.new"
  visudo -qcf "$1.new" > /dev/null || { rm -f "$1.new"; fail $"visudo does not take $1"; }
  mv "$1.new" "$1"
}
remove() {
  [ -e "$place" ] || { say $"There is no Debian to remove."; return; }
  unmount_rest sudo
  sudo rm -rf --one-file-system "$place" "$rule" || fail $"sudo refused $(id -un): $place stays"
  say $"$place is removed."
}

case "${1:-}" in
  --make)
    self=debian_root state=$place/log passwordless=$2
    mkdir -p "$state"
    make_debian "${@:3}"
    exit ;;
  --remove) self=clean-root; remove; exit ;;
esac
this=$(. /etc/os-release 2> /dev/null && echo "${PRETTY_NAME:-}") || true
case "$(uname -s)-$(uname -m)" in
  Linux-x86_64 | Linux-aarch64) ;;
  *) fail $"this is ${this:-$(uname -sm)}, but this needs Linux on a 64-bit Intel, AMD or ARM processor: use docker/ in this repository" ;;
esac
[ "$(id -u)" != 0 ] || fail $"this is $this, where a Debian of its own is needed, and that is for a user with sudo, not for root; or use docker/ in this repository"
check_folder
mapfile -t needed < <(folders)
if ! is_ready "${needed[@]}"; then
  command -v sudo > /dev/null || fail $"this is $this, where a Debian of its own is needed, and there is no sudo; or use docker/ in this repository"
  passwordless=no
  sudo -kn true 2> /dev/null && passwordless=yes
  if [ ! -e "$place/complete" ]; then
    say $"This is $this, which has no ROS 1: a Debian 12 goes into $place, once (some minutes, 3 GB with all that setup installs; make clean-root removes it)."
  fi
  [ "$passwordless" = yes ] || say $"sudo asks for your password."
  [ ! -f "$place/folders" ] || mapfile -t needed < <(sort -u "$place/folders" - <<< "$(printf '%s\n' "${needed[@]}")")
  copy=$(mktemp -d /tmp/debian-root.XXXXXX)  # of a home on NFS root may read nothing
  (cd "$root" && cp -r --parents scripts src/interfaces/terminal_language "$copy")
  cd "$copy"
  sudo "MIRROR=${MIRROR:-}" "http_proxy=${http_proxy:-}" "https_proxy=${https_proxy:-}" "LANGUAGE=${LANGUAGE:-}" \
    bash scripts/debian_root.sh --make "$passwordless" "$(id -un)" "${needed[@]}" || exit 2
  cd "$OLDPWD"
  rm -rf "$copy"
fi
trap - EXIT
exec sudo -n -- "$place/enter" "$PWD" "$environment" "$root/scripts/$1" "${@:2}"
