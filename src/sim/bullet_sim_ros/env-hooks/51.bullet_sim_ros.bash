# Sourced by devel/setup.bash: roscd and rosls, which Debian leaves in a folder that no setup file reads.
if [ -r /usr/share/bash-completion/completions/roscd ]; then
  . /usr/share/bash-completion/completions/roscd
  # rosed calls $EDITOR or else vim: where that is not here, or is gedit without a screen, another one.
  eval "_debians_$(declare -f rosed)"
  rosed() {
    EDITOR="_rosed_with ${EDITOR:-vim}" _debians_rosed "$@"
  }
  _rosed_with() {  # EDITOR... FILE
    local editor file=${!#} why="is not installed"
    [ "$1" != gedit ] || [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || why="has no screen here"
    if [ "$why" = "is not installed" ] && command -v "$1" > /dev/null; then
      "$@"
      return
    fi
    for editor in nano vim vi editor; do
      if command -v "$editor" > /dev/null; then
        _rosed_says "rosed: $1 $why; $editor opens $file"
        "$editor" "$file"
        return
      fi
    done
    _rosed_says "rosed: $1 $why, and no other editor is installed; type: sudo apt-get install nano"
    return 1
  }
  _rosed_says() { { python3 -m terminal_language <<< "$1" 2> /dev/null || echo "$1"; } >&2; }
fi
