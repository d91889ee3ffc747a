#!/usr/bin/env python3
"""Writes the package's control files into STAGE/DEBIAN, and prints the package's name.

    deb_control.py STAGE PREFIX
"""

from __future__ import annotations

import gzip
import hashlib
import platform
import subprocess
import sys
import time
from email.utils import formatdate
from importlib.metadata import Distribution
from pathlib import Path

from deb_stage import MODULES, ROOT, epoch, required, settle_times
from package_lists import these_lists

sys.path.insert(0, str(ROOT / "src/sim/bullet_sim/src"))
from bullet_sim import __version__

NAME = "ros-courses"
MAINTAINER = "ros1-driving-courses <courses@example.org>"
# Sections of debian.txt: needed only by a learner's own workspace; needed only by tests.
RECOMMENDED, OMITTED = ("building",), ("testing",)
ABOUT = """ROS 1 driving courses with a simulator behind Gazebo's interface
 The courses' robots, worlds, lessons, navigation and simulator, below {prefix}.
 To use them: source {prefix}/setup.bash"""
# Removes files that root's Python added to the folder, which dpkg does not know.
PRERM = """#!/bin/sh
set -e
case "$1" in remove|deconfigure)
  find {prefix} -name __pycache__ -type d -prune -exec rm -rf {{}} + ;;
esac
"""
# dpkg takes /opt away with the last package in it, which no machine was installed without.
POSTRM = """#!/bin/sh
set -e
mkdir -p /opt
"""


def sections(text: str) -> dict[str, list[str]]:
    """Packages of debian.txt by section; a comment after an empty line begins a section."""
    found: dict[str, list[str]] = {}
    before, current = "", ""
    for line in text.splitlines():
        if line.startswith("#") and not before:
            current = line.lstrip("# ")
        elif name := line.partition("#")[0].strip():
            found.setdefault(current, []).append(name)
        before = line.strip()
    return found


def dependencies(text: str) -> tuple[list[str], list[str]]:
    """Depends and Recommends, from the text of debian.txt."""
    by_section = sections(text)
    if missing := {*RECOMMENDED, *OMITTED} - by_section.keys():
        raise ValueError(f"debian.txt: no section {', '.join(sorted(missing))}")
    depends = {name for section, names in by_section.items()
               if section not in (*RECOMMENDED, *OMITTED) for name in names}
    recommends = {name for section in RECOMMENDED for name in by_section[section]}
    return sorted(depends), sorted(recommends - depends)


def python_range(version: tuple[int, int] = sys.version_info[:2]) -> list[str]:
    """Dependencies on one Python version, for which PyPI's packages are built."""
    major, minor = version
    return [f"python3 (>= {major}.{minor})", f"python3 (<< {major}.{minor + 1})"]


def version(when: int) -> str:
    """Our version, the commit's time and name, and Debian's release: later ones count as newer."""
    told = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty=.changed",
                           "--exclude=*"], capture_output=True, text=True, check=False)
    commit = f".{told.stdout.strip()}" if told.returncode == 0 else ""
    minute = time.strftime("%Y%m%d%H%M", time.gmtime(when))
    release = platform.freedesktop_os_release()["VERSION_ID"]
    return f"{__version__}+{minute}{commit}+deb{release}"


def control(prefix: str, version: str, architecture: str, size_kib: int, packages: str) -> str:
    """The control file; `packages` is the text of debian.txt."""
    depends, recommends = dependencies(packages)
    fields = {
        "Package": NAME, "Version": version, "Architecture": architecture,
        "Maintainer": MAINTAINER, "Installed-Size": str(size_kib), "Section": "education",
        "Priority": "optional", "Depends": ", ".join([*python_range(), *depends]),
        "Recommends": ", ".join(recommends), "Description": ABOUT.format(prefix=prefix)}
    return "".join(f"{name}: {value}\n" for name, value in fields.items())


def copyright_text(prefix: str, packages: list[Distribution]) -> str:
    """Our licence, and the places of the PyPI packages' licences."""
    ours = (ROOT / "LICENSE").read_text(encoding="utf-8")
    lines = [f"{NAME}, below {prefix}, with these exceptions:", ""]
    for package in packages:
        about = package.metadata
        licence = about.get("License-Expression") or about.get("License") or "see its metadata"
        lines.append(f"  {about['Name']} {package.version}: {licence.splitlines()[0]}")
    lines += ["", f"Their licences in full are in {prefix}/{MODULES}/*.dist-info/.", "", ours]
    return "\n".join(lines)


def checksums(stage: Path) -> str:
    """md5sums as dpkg --verify reads them."""
    files = sorted(path for path in stage.rglob("*") if path.is_file() and not path.is_symlink()
                   and "DEBIAN" not in path.relative_to(stage).parts[:1])
    return "".join(f"{hashlib.md5(path.read_bytes()).hexdigest()}  {path.relative_to(stage)}\n"
                   for path in files)


def main() -> int:
    """Returns the exit code."""
    stage, prefix, when = Path(sys.argv[1]), sys.argv[2], epoch()
    number, docs = version(when), stage / "usr/share/doc" / NAME
    docs.mkdir(parents=True, exist_ok=True)
    (docs / "copyright").write_text(copyright_text(prefix, required()), encoding="utf-8")
    change = (f"{NAME} ({number}) stable; urgency=low\n\n  * Made of the sources of that time.\n\n"
              f" -- {MAINTAINER}  {formatdate(when)}\n")
    (docs / "changelog.gz").write_bytes(gzip.compress(change.encode(), 9, mtime=0))
    told = subprocess.run(["dpkg", "--print-architecture"], capture_output=True, text=True,
                          check=True)
    architecture, about = told.stdout.strip(), stage / "DEBIAN"
    size = sum(path.lstat().st_size for path in stage.rglob("*")) // 1024
    about.mkdir(exist_ok=True)
    packages = (these_lists() / "debian.txt").read_text(encoding="utf-8")
    (about / "control").write_text(control(prefix, number, architecture, size, packages),
                                   encoding="utf-8")
    (about / "md5sums").write_text(checksums(stage), encoding="utf-8")
    for name, text in (("prerm", PRERM.format(prefix=prefix)), ("postrm", POSTRM)):
        (about / name).write_text(text, encoding="utf-8")
        (about / name).chmod(0o755)
    settle_times(stage, when)
    print(f"{NAME}_{number}_{architecture}.deb")
    return 0


if __name__ == "__main__":
    sys.exit(main())
