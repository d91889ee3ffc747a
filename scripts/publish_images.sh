#!/usr/bin/env bash
# Pushes images that `make image` saved, as one image for all their architectures, by buildah.
#
#   scripts/publish_images.sh DESTINATION SUITE FILE...
#
# DESTINATION is a repository, such as docker://HOST/OWNER/NAME (after buildah login), or oci:FOLDER to try it. It gets the
# tags VERSION-SUITE and SUITE.
on_any_linux=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
[ $# -ge 3 ] || fail "usage: publish_images.sh DESTINATION SUITE FILE..."
destination=$1 suite=$2 version=$(our_version) list=courses-$$
command -v buildah >/dev/null || fail $"images are pushed by buildah; type: sudo apt install buildah"
for file in "${@:3}"; do [ -f "$file" ] || fail $"there is no $file"; done
trap 'buildah manifest rm "$list" >/dev/null 2>&1 || true' EXIT
buildah manifest create "$list" >/dev/null
for file in "${@:3}"; do buildah manifest add "$list" "oci-archive:$file:ros1-driving-courses:$version-$suite" >/dev/null; done
for tag in "$version-$suite" "$suite"; do
  buildah manifest push --quiet --all "$list" "$destination:$tag"
  say "$destination:$tag"
done
