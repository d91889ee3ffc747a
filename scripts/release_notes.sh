#!/usr/bin/env bash
# Prints what CHANGELOG.md says of a release, without its heading; fails if its tag is not v and our version.
#
#   scripts/release_notes.sh v1.0.0
on_any_linux=yes
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
tag=${1:-} version=$(our_version)
[ "$tag" = "v$version" ] || fail "the tag is '$tag', but the version is $version: tag v$version, or change __version__"
notes=$(awk -v heading="## $version " 'index($0, "## ") == 1 {within = index($0, heading) == 1; next} within' "$root/CHANGELOG.md")
[ -n "$notes" ] || fail "CHANGELOG.md has no '## $version'"
say "$notes"
