#!/usr/bin/env python3
"""Compares our lists of Debian packages with a release that they were not made for.

    scripts/check_releases.sh [RELEASE]      Debian's testing, if none is named

What the newest release of our lists takes is looked up there; apt fetches the indexes, in a folder
of its own. Exit code 0: all is there; 1: something is missing; 2: apt could not read the release.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from package_lists import DEBIAN, Package, Platform, Table
from rosdep_keys import MIRROR, debian_lists

KEYS = "/usr/share/keyrings/debian-archive-keyring.gpg"


class CheckError(RuntimeError):
    """apt could not do it; the text is for people to read."""


def index(platform: Platform, source: str) -> dict[str, debian_lists.Binary]:
    """The release's packages by name; `source` is apt's line for it."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("lists/partial", "archives/partial"):
            Path(folder, name).mkdir(parents=True)
        Path(folder, "sources.list").write_text(f"{source}\n", "utf-8")
        options = [word for setting in (
            f"Dir::Etc::SourceList={folder}/sources.list", "Dir::Etc::SourceParts=/dev/null",
            f"Dir::State={folder}", "Dir::State::status=/dev/null", f"Dir::Cache={folder}",
            f"APT::Architecture={platform.architecture}", "Acquire::Languages=none",
            f"APT::Architectures={platform.architecture}", "APT::Sandbox::User=root",
            "APT::Update::Error-Mode=any") for word in ("-o", setting)]
        done = subprocess.run(["apt-get", *options, "-q", "update"], capture_output=True, text=True,
                              env=os.environ | {"LC_ALL": "C"}, check=False)
        if done.returncode:
            why = [line for line in done.stderr.splitlines() if line.startswith("E: ")]
            raise CheckError(f"{platform.release}: {(why or ['apt-get update failed'])[0]}")
        told = subprocess.run(["apt-cache", *options, "dumpavail"], capture_output=True,
                              text=True, check=True)
    found = debian_lists.read_packages(told.stdout.splitlines())
    if "python3" not in found:
        raise CheckError(f"{platform.release}: is no whole release, as it has no python3; name "
                         "one, such as testing")
    return found


def wanted(table: Table, platform: Platform) -> list[Package]:
    """What our lists take on a platform."""
    return [package for kind in DEBIAN for packages in table.sections(kind).values()
            for package in packages if not package.only or platform.is_one_of(package.only)]


def major(version: str, parts: int = 1) -> str:
    """The upstream version's first parts: 3 or 3.13 of 1:3.13.5-2."""
    return ".".join(re.findall(r"\d+", version.rpartition(":")[2])[:parts])


def compare(packages: list[Package], before: dict[str, debian_lists.Binary],
            after: dict[str, debian_lists.Binary]) -> tuple[list[str], list[str]]:
    """A line for each package that is missing, and for each that changed its major version."""
    missing = [f"missing: {package.name} ({package.why})" for package in packages
               if package.name not in after]
    names = sorted({package.name for package in packages} & before.keys() & after.keys())
    pairs = [("Python", *(major(each["python3"].version, 2) for each in (before, after)))]
    pairs += [(name, *(major(each[name].version) for each in (before, after))) for name in names]
    return missing, [f"changed: {name} {old} -> {new}" for name, old, new in pairs if old != new]


def main() -> int:
    """Returns the exit code."""
    table = Table()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("release", nargs="?", default="testing", metavar="RELEASE")
    parser.add_argument("--source", metavar="LINE", help="of apt, with {} for a release's name",
                        default=f"deb [signed-by={KEYS}] {MIRROR.removesuffix('/dists')} {{}} main")
    given = parser.parse_args()
    newest, told, code = list(table.data["releases"])[-1], {}, 0
    for architecture in table.data["architectures"]:
        try:
            before, after = (index(Platform(release, architecture), given.source.format(release))
                             for release in (newest, given.release))
        except CheckError as error:
            print(f"check_releases: {error}", file=sys.stderr)
            return 2
        packages = wanted(table, Platform(newest, architecture))
        missing, changed = compare(packages, before, after)
        code = code or bool(missing)
        for line in (*missing, *changed):
            told.setdefault(line, []).append(architecture)
    for line, where in told.items():
        only = "" if len(where) == len(table.data["architectures"]) else f", {where[0]} alone"
        print(f"{given.release}: {line}{only}")
    if not code:
        print(f"{given.release} has all that our lists for {newest} take")
    return code


if __name__ == "__main__":
    sys.exit(main())
