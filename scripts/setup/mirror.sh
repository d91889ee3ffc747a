# MIRROR=cn, or the address of a Debian archive: where apt and pip fetch from. Without it they read their own settings.

# Sets `archive`, the address of Debian's packages, `sources`, apt's options for it (whose list of sources is written into
# a folder), and pip's index, if MIRROR= asks for them.
use_mirror() {  # folder, Debian's release
  archive= sources=()
  case "${MIRROR:-}" in
    '') return ;;
    cn)  # of Tsinghua University, whose help pages give both; by http, as a bare Debian has no certificates: apt checks signatures
      archive=http://mirrors.tuna.tsinghua.edu.cn/debian
      export PIP_INDEX_URL=${PIP_INDEX_URL:-https://mirrors.tuna.tsinghua.edu.cn/pypi/web/simple} ;;
    http://?* | https://?*) archive=${MIRROR%/} ;;
    *) fail $"MIRROR=$MIRROR: write cn, or the address of a Debian archive, such as http://mirror.example.edu/debian" ;;
  esac
  printf 'deb %s main\n' "$archive $2" "$archive $2-updates" "$archive-security $2-security" >"$1/mirror.list"
  sources=(-o "Dir::Etc::SourceList=$1/mirror.list" -o Dir::Etc::SourceParts=- -o APT::Get::List-Cleanup=0)
}
