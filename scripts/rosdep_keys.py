#!/usr/bin/env python3
"""Writes src/workspace_needs/rosdep/: the keys by which `rosdep` knows Debian's and our packages.

    python3 scripts/rosdep_keys.py --ours         after a new package of ours; needs no network
    python3 scripts/rosdep_keys.py                and Debian's, from the lists of a mirror (120 MB)
    python3 scripts/rosdep_keys.py --lists DIR    the same, from lists fetched to DIR
    python3 scripts/rosdep_keys.py --ours --check exit code 1 if they are not what would be written
"""

from __future__ import annotations

import argparse
import gzip
import itertools
import lzma
import sys
import tempfile
import urllib.request
from pathlib import Path
from xml.etree.ElementTree import parse

import yaml

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "src/workspace_needs"
sys.path.insert(0, str(PACKAGE / "src"))

from workspace_needs import debian_lists, key_files  # noqa: E402  (works where nothing is built)

MIRROR = "http://deb.debian.org/debian/dists"
RELEASES = ("bookworm", "trixie")  # Debian 12 and 13
FILES = {"Packages.xz": "main/binary-amd64/Packages.xz",
         "Contents-all.gz": "main/Contents-all.gz", "Contents-amd64.gz": "main/Contents-amd64.gz"}


def fetch(folder: Path) -> None:
    """Downloads what is not there yet."""
    for release, (name, path) in itertools.product(RELEASES, FILES.items()):
        target = folder / f"{release}-{name}"
        if not target.exists():
            print(f"fetching {release}'s {name}")
            urllib.request.urlretrieve(f"{MIRROR}/{release}/{path}", target)


def read_release(folder: Path, release: str) -> tuple:
    """Its ROS packages and its binary packages."""
    with lzma.open(folder / f"{release}-Packages.xz", "rt", encoding="utf-8") as lines:
        binaries = debian_lists.read_packages(lines)
    with gzip.open(folder / f"{release}-Contents-all.gz", "rt", encoding="utf-8") as first, \
            gzip.open(folder / f"{release}-Contents-amd64.gz", "rt", encoding="utf-8") as second:
        return debian_lists.ros_packages(itertools.chain(first, second), binaries), binaries


def debian_text(folder: Path) -> str:
    """What rosdep/debian.yaml should be."""
    data = PACKAGE / "data/system_keys.yaml"
    system = key_files.check_system_keys(yaml.safe_load(data.read_text("utf-8")), data.name)
    fetch(folder)
    releases = {release: read_release(folder, release) for release in RELEASES}
    return key_files.debian_text(key_files.debian_keys(releases, system), RELEASES)


def our_packages() -> list[str]:
    """Names of the packages of src/, without those in tests."""
    return [parse(path).getroot().findtext("name", "").strip()
            for path in sorted((ROOT / "src").glob("**/package.xml"))
            if "test" not in path.relative_to(ROOT).parts]


def main() -> int:
    """Write, or compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ours", action="store_true", help="leave Debian's keys as they are")
    parser.add_argument("--lists", type=Path, metavar="DIR", help="folder of Debian's lists")
    parser.add_argument("--check", action="store_true", help="write nothing, only compare")
    args = parser.parse_args()
    target = PACKAGE / "rosdep/debian.yaml"
    texts = {}
    try:
        if args.ours:
            debian = target.read_text("utf-8")
        else:
            with tempfile.TemporaryDirectory() as folder:
                debian = texts[target] = debian_text(args.lists or Path(folder))
    except (OSError, key_files.KeyFileError) as error:
        print(f"rosdep_keys: {error}", file=sys.stderr)
        return 1
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    texts[PACKAGE / "rosdep/ours.yaml"] = key_files.ours_text(
        our_packages(), yaml.load(debian, loader))
    stale = 0
    for path, text in texts.items():
        if path.is_file() and path.read_text("utf-8") == text:
            continue
        if args.check:
            print(f"{path.relative_to(ROOT)} is not up to date: python3 scripts/rosdep_keys.py",
                  file=sys.stderr)
            stale = 1
        else:
            path.write_text(text, encoding="utf-8")
            print(f"written: {path.relative_to(ROOT)}")
    return stale


if __name__ == "__main__":
    sys.exit(main())
