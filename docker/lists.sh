#!/usr/bin/env bash
# lists.sh FOLDER: the checksums of all that an image is made from, except what is mounted into it.
cd "$1"
find dependencies docker .dockerignore -type f ! -name compose.yaml -print0 |
  LC_ALL=C sort -z | xargs -0 sha256sum
