"""The table dependencies/packages.yaml, and the lists that are generated from it.

A platform is a release and an architecture of Debian: bookworm-amd64. Its folder below
dependencies/ has apt's lists (debian.txt, debian-test.txt) and pip's requirement files, which
setup reads as they are.
"""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import yaml

FOLDER = Path(__file__).resolve().parent.parent / "dependencies"
MADE = "# Written from packages.yaml by scripts/refresh_pins.py; change that table."
DEBIAN = ("debian", "debian-test")  # the second for `make test` alone
SOURCE = "requirements-source"  # built from source by setup; all other lists are wheels


@dataclass(frozen=True)
class Package:
    """A row of the table."""

    name: str
    why: str
    only: tuple[str, ...] = ()  # releases, architectures or release/architecture; (): all
    source: tuple[str, ...] = ()
    version: dict[str, str] = field(default_factory=dict)  # release -> limits, such as <2


@dataclass(frozen=True)
class Platform:
    """A release and an architecture."""

    release: str
    architecture: str

    def __str__(self) -> str:
        return f"{self.release}-{self.architecture}"

    def is_one_of(self, places: tuple[str, ...]) -> bool:
        """Whether one of the places (only: of the table) is this."""
        return not {self.release, self.architecture,
                    f"{self.release}/{self.architecture}"}.isdisjoint(places)


@dataclass(frozen=True)
class Pin:
    """A version of a package, and the hashes (SHA-256) of the files that may be installed."""

    version: str
    hashes: tuple[str, ...] = ()


class Table:
    """dependencies/packages.yaml."""

    def __init__(self, folder: Path = FOLDER) -> None:
        self.folder = folder
        self.data = yaml.safe_load((folder / "packages.yaml").read_text("utf-8"))

    @cached_property
    def platforms(self) -> list[Platform]:
        """All supported platforms."""
        return [Platform(release, architecture) for release in self.data["releases"]
                for architecture in self.data["architectures"]]

    def sections(self, kind: str) -> dict[str, list[Package]]:
        """Packages of `python` or one of DEBIAN, by list or section."""
        return {section: [_package(name, row) for name, row in rows.items()]
                for section, rows in self.data[kind].items()}

    def requirements(self, platform: Platform) -> dict[str, list[Package]]:
        """Packages by list, as pip installs them there; SOURCE is empty if all have wheels."""
        lists: dict[str, list[Package]] = {SOURCE: []}
        for name, packages in self.sections("python").items():
            here = [package for package in packages
                    if not package.only or platform.is_one_of(package.only)]
            built = [package for package in here if platform.is_one_of(package.source)]
            lists[SOURCE] += built
            lists[name] = [package for package in here if package not in built]
        return lists

    def debian_text(self, platform: Platform, name: str) -> str:
        """A list of DEBIAN for a platform."""
        parts = [f"{MADE}\n"]
        for section, packages in self.sections(name).items():
            here = [package for package in packages
                    if not package.only or platform.is_one_of(package.only)]
            parts.append(f"\n# {section}\n" + "".join(
                f"{package.name:27} # {package.why}\n" for package in here))
        return "".join(parts)

    def path(self, platform: Platform, name: str) -> Path:
        """The file of a list."""
        return self.folder / str(platform) / f"{name}.txt"

    def pins(self, platform: Platform) -> dict[str, Pin]:
        """The pins in a platform's current lists."""
        found: dict[str, Pin] = {}
        for name in self.requirements(platform):
            path = self.path(platform, name)
            found |= read_pins(path.read_text("utf-8")) if path.exists() else {}
        return found


def requirements_text(packages: list[Package], pins: dict[str, Pin]) -> str:
    """A requirement file in pip's hash-checking mode."""
    lines = [MADE]
    for package in packages:
        pin = pins[package.name]
        lines.append(" \\\n".join([f"{package.name}=={pin.version}", *(
            f"    --hash=sha256:{digest}" for digest in pin.hashes)]) + f"  # {package.why}")
    return "\n".join(lines) + "\n"


def read_pins(text: str) -> dict[str, Pin]:
    """The reverse of requirements_text."""
    joined = re.sub(r"#.*", "", text).replace("\\\n", " ")
    pins = {}
    for line in joined.splitlines():
        if words := line.split():
            name, _, version = words[0].partition("==")
            pins[name] = Pin(version, tuple(word.partition("sha256:")[2] for word in words[1:]))
    return pins


def this_platform() -> Platform:
    """This machine's platform."""
    told = dict(line.partition("=")[::2] for line in
                Path("/etc/os-release").read_text("utf-8").splitlines())
    architecture = subprocess.run(["dpkg", "--print-architecture"], capture_output=True,
                                  text=True, check=True).stdout.strip()
    return Platform(told.get("VERSION_CODENAME", "").strip('"'), architecture)


def these_lists() -> Path:
    """The folder of this machine's lists."""
    return FOLDER / str(this_platform())


def _package(name: str, row: str | dict) -> Package:
    if isinstance(row, str):
        return Package(name, row)
    lists = {key: tuple(row[key]) for key in ("only", "source") if key in row}
    return Package(name, row["why"], version=row.get("version", {}), **lists)
