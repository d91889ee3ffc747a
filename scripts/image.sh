#!/usr/bin/env bash
# Builds the course image of docker/Dockerfile, and saves it as out/ros1-driving-courses_VERSION_SUITE_ARCHITECTURE.tar:
# an OCI archive that `docker load` and `podman load` read.
#
#   scripts/image.sh [--suite trixie]
#
# By buildah, whose archive is compressed, or by docker. BASE=IMAGE replaces Debian's image, by its mirror for instance.
on_any_linux=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
suite=bookworm
[ $# -eq 0 ] || [ "$*" = "--suite ${2:-}" ] || fail $"unknown option $1; there is --suite RELEASE"
[ $# -eq 0 ] || suite=$2
case "$suite" in bookworm | trixie) ;; *) fail $"SUITE=$suite: there are bookworm and trixie" ;; esac

name=ros1-driving-courses version=$(our_version)
arguments=(--build-arg "SUITE=$suite" --file "$root/docker/Dockerfile" --tag "$name:$version-$suite" --tag "$name:$suite")
for setting in BASE MIRROR PIP_INDEX_URL; do [ -z "${!setting:-}" ] || arguments+=(--build-arg "$setting=${!setting}"); done
if command -v buildah >/dev/null; then engine=buildah
elif docker info >/dev/null 2>&1; then engine=docker
else fail $"an image is made by buildah, or by docker, which does not answer; type: sudo apt install buildah"; fi

"$engine" build "${arguments[@]}" "$root"
architecture=$(dpkg --print-architecture 2>/dev/null) || case $(uname -m) in aarch64) architecture=arm64 ;; *) architecture=amd64 ;; esac
file=out/${name}_${version}_${suite}_$architecture.tar
mkdir -p "$root/out"
rm -f "$root/$file" "$root/$file.part"
if [ "$engine" = docker ]; then docker save --output "$root/$file.part" "$name:$version-$suite" "$name:$suite"
else
  layout=$(mktemp -d "$root/out/image.XXXXXX")
  trap 'rm -rf "$layout" "$root/$file.part"' EXIT
  for tag in "$version-$suite" "$suite"; do buildah push --quiet "$name:$tag" "oci:$layout:$name:$tag"; done
  python3 "$root/scripts/loadable_image.py" "$layout" "$root/$file.part"
fi
mv "$root/$file.part" "$root/$file"
size=$(($(stat -c %s "$root/$file") / 1000000))
say $"$file: $size MB, made in ${SECONDS} s. Next, where it is used: docker load --input $file"
