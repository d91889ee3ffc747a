#!/usr/bin/env bash
# lists.sh FOLDER: the checksums of all that an image is made from, except what is mounted into it.
# Without compose files, which the host reads, and without what editors and file managers leave.
set -euo pipefail
cd "$1"
find dependencies docker .dockerignore -type f \( ! -name '.*' -o -path .dockerignore \) ! -name '*~' \
  ! -name 'compose*.yaml' ! -name 'compose*.yml' -print0 |
  LC_ALL=C sort -z | xargs -0 sha256sum
