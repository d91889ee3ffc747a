# To be sourced by scripts that start the server or the client.

# Prints its arguments with the ROS remappings (NAME:=VALUE) after all others, one line.
relocate_remappings() {
  words="" remappings=""
  for word in "$@"; do
    case "$word" in
      *:=*) remappings="$remappings $word" ;;
      *) words="$words $word" ;;
    esac
  done
  words="$words$remappings"
  echo "${words# }"
}
