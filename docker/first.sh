#!/bin/bash
# Installs packages on a bare Debian, before there is anything else: first.sh RELEASE PACKAGE...
set -euo pipefail
fail() { printf 'docker: %s\n' "$1" >&2; exit 1; }
. "${0%/*}/mirror.sh"
use_mirror "${0%/*}" "$1"
apt-get "${sources[@]}" update
apt-get "${sources[@]}" install -y --no-install-recommends "${@:2}"
