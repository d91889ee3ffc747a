#!/bin/bash -p
# Runs a command as the user who calls this by sudo, in the Debian beside this file: enter DIR ENVIRONMENT COMMAND...
#
# scripts/debian_root.sh installs it, owned by root, where sudo asks for no password. So root's part takes nothing from its
# caller but the user's number. ENVIRONMENT is a file of NAME=VALUE, each with a NUL behind it; it is removed once read.
set -euo pipefail
PATH=/usr/sbin:/usr/bin:/sbin:/bin
here=$(dirname "$(realpath "$0")")
debian=$here/debian
if [ "$(id -u)" != 0 ] || [ "${SUDO_UID:-0}" = 0 ]; then echo "enter: call it by sudo, as a user other than root" >&2; exit 2; fi

# The line of the user in passwd, shadow or group, as this machine has it: sudo asks for the same password in there.
keep_line() {
  local file=$debian/etc/$1 line=$2
  grep -qsxFf <(printf '%s\n' "$line") "$file" || { sed -i "/^${line%%:*}:/d" "$file" && printf '%s\n' "$line" >> "$file"; }
}
# What is mounted here is seen by this command alone.
enter() {
  set -euo pipefail
  local mounted=()
  IFS=: read -r name _ user group full home _ < <(getent passwd "$SUDO_UID")
  exec 9< "$here"
  flock 9
  keep_line passwd "$name:x:$user:$group:$full:$home:/bin/bash"
  keep_line shadow "$(getent shadow "$name" || echo "$name:!:19000:0:99999:7:::")"
  grep -qs "^[^:]*:[^:]*:$group:" "$debian/etc/group" || keep_line group "$(getent group "$group")"
  exec 9<&-

  while read -r folder; do
    # One below another is there with that; a link that its owner put there could lead the mount anywhere.
    for other in "${mounted[@]}"; do [[ $folder != "$other"/* ]] || continue 2; done
    [ -d "$folder" ] || continue
    mkdir -p -- "$debian$folder"
    mount --rbind -- "$folder" "$debian$folder"
    mounted+=("$folder")
  done < "$here/folders"
  for file in /etc/resolv.conf /etc/hosts /etc/localtime; do
    [ -f "$file" ] || continue
    [ ! -L "$debian$file" ] || rm -f "$debian$file"  # it would lead to the machine's own
    [ -f "$debian$file" ] || : > "$debian$file"
    mount --bind "$(realpath "$file")" "$debian$file"
  done
  groups=$(id -G "$name")
  # From here on as the user.
  exec chroot --userspec="$user:$group" --groups="${groups// /,}" "$debian" /bin/bash -pc '
    mapfile -td "" environment < "$2" && rm -f -- "$2"
    cd -- "$1" || exit 2
    exec env -i "${environment[@]}" "${@:3}"' enter "$@"
}
# In a container / may be no mount point, and is private there.
propagation=slave
unshare --mount --propagation slave true 2> /dev/null || propagation=unchanged
exec unshare --mount --propagation "$propagation" -- /bin/bash -pc \
  "$(declare -p PATH here debian; declare -f keep_line enter)"$'\nenter "$@"' enter "$@"
