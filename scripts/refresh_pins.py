#!/usr/bin/env python3
"""Generates the lists of packages in dependencies/ from its table, and says what changed.

    scripts/refresh_pins.py                  all releases: the newest versions that the table allows
    scripts/refresh_pins.py trixie           only that release
    scripts/refresh_pins.py --keep           keeps versions; newest ones only for new packages

Needs PyPI, by pip's own settings, and what setup installs. Run the tests with new versions.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from package_lists import DEBIAN, SOURCE, Package, Pin, Platform, Table, requirements_text

OLDEST_GLIBC = 5  # the first that manylinux's wheels are named after, of the minor version


class RefreshError(RuntimeError):
    """pip did not find what the table requires; the text is for people to read."""


def wheel_options(table: Table, platform: Platform) -> list[str]:
    """Options that make pip choose wheels for that platform."""
    release = table.data["releases"][platform.release]
    machine = table.data["architectures"][platform.architecture]
    tags = [f"manylinux_2_{minor}" for minor in range(release["glibc"], OLDEST_GLIBC - 1, -1)]
    named = [word for tag in (*tags, "manylinux2014", "manylinux2010", "manylinux1")
             for word in ("--platform", f"{tag}_{machine}")]
    return ["--only-binary", ":all:", "--implementation", "cp", "--python-version",
            release["python"], *named]


def ask_pip(asked: list[str], options: list[str], where: str) -> dict[str, Pin]:
    """What pip would install for these requirements, by name in lower case."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        done = subprocess.run(
            [sys.executable, "-m", "pip", "install", "--dry-run", "--ignore-installed", "--no-deps",
             "--quiet", "--disable-pip-version-check", "--target", f"{folder}/target",
             "--report", str(report), *options, *asked],
            capture_output=True, text=True, check=False)
        if done.returncode:
            told = [line for line in done.stderr.splitlines() if line.startswith("ERROR")]
            raise RefreshError(f"{where}: {(told or ['pip failed'])[-1]}")
        items = json.loads(report.read_text("utf-8"))["install"]
    return {item["metadata"]["name"].lower().replace("_", "-"): Pin(
        item["metadata"]["version"], (item["download_info"]["archive_info"]["hashes"]["sha256"],))
        for item in items}


def look_up(packages: list[Package], versions: dict[str, str], options: list[str],
            platform: Platform) -> dict[str, Pin]:
    """Pins of these packages; `versions` has fixed ones."""
    if not packages:
        return {}
    asked = [f"{package.name}=={versions[package.name]}" if package.name in versions
             else package.name + package.version.get(platform.release, "") for package in packages]
    found = ask_pip(asked, options, str(platform))
    return {package.name: found[package.name.lower().replace("_", "-")] for package in packages}


def resolve(table: Table, release: str, keep: bool) -> dict[Platform, dict[str, Pin]]:
    """Pins for a release; one version of a package on all architectures."""
    platforms = [platform for platform in table.platforms if platform.release == release]
    settled = {name: pin.version for platform in platforms
               for name, pin in table.pins(platform).items() if keep}
    found = {}
    for platform in platforms:
        lists = table.requirements(platform)
        wheels = [package for name, packages in lists.items() if name != SOURCE
                  for package in packages]
        pins = look_up(wheels, settled, wheel_options(table, platform), platform)
        pins |= look_up(lists[SOURCE], settled, ["--no-binary", ":all:"], platform)
        settled |= {name: pin.version for name, pin in pins.items()}
        found[platform] = pins
    return found


def changes(old: dict[str, Pin], new: dict[str, Pin]) -> list[str]:
    """A line for each package that changed."""
    lines = []
    for name in sorted(old.keys() | new.keys(), key=str.lower):
        before, now = old.get(name), new.get(name)
        if before is None:
            lines.append(f"{name}: new, {now.version}")
        elif now is None:
            lines.append(f"{name}: gone, was {before.version}")
        elif before.version != now.version:
            lines.append(f"{name}: {before.version} -> {now.version}")
        elif before.hashes != now.hashes:
            lines.append(f"{name}: {now.version} as before, another file")
    return lines


def listed(text: str) -> set[str]:
    """Names of a debian.txt or debian-test.txt."""
    return {name for line in text.splitlines() if (name := line.partition("#")[0].strip())}


def write(table: Table, platform: Platform, pins: dict[str, Pin]) -> list[str]:
    """Write all lists of a platform; returns a line for each change."""
    told = changes(table.pins(platform), pins)
    for list_name in DEBIAN:
        debian = table.path(platform, list_name)
        before = listed(debian.read_text("utf-8")) if debian.exists() else set()
        debian.parent.mkdir(exist_ok=True)
        debian.write_text(text := table.debian_text(platform, list_name), "utf-8")
        told += [f"{name}: {'new' if name in listed(text) else 'gone'} ({list_name}.txt)"
                 for name in sorted(before ^ listed(text))]
    for name, packages in table.requirements(platform).items():
        path = table.path(platform, name)
        if packages:
            path.write_text(requirements_text(packages, pins), "utf-8")
        else:
            path.unlink(missing_ok=True)
    return told


def main() -> int:
    """Returns the exit code."""
    table = Table()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("releases", nargs="*", metavar="RELEASE",
                        help=f"{', '.join(table.data['releases'])}; all, if none is named")
    parser.add_argument("--keep", action="store_true", help="the versions stay as they are")
    given = parser.parse_args()
    if unknown := set(given.releases) - table.data["releases"].keys():
        parser.error(f"there is no {', '.join(sorted(unknown))} in dependencies/packages.yaml, "
                     f"but {', '.join(table.data['releases'])}")
    try:
        found = {platform: pins for release in given.releases or table.data["releases"]
                 for platform, pins in resolve(table, release, given.keep).items()}
    except RefreshError as error:
        print(f"error: {error}; nothing is written", file=sys.stderr)
        return 1
    for platform, pins in found.items():
        for line in write(table, platform, pins) or ["nothing changed"]:
            print(f"{platform}: {line}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
