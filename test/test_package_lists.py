"""dependencies/: the table, the lists that are written from it, and what setup says of machines."""

import hashlib
import subprocess
import sys
from email.utils import formatdate
from pathlib import Path

import pytest
from packaging.specifiers import SpecifierSet

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))

from package_lists import (  # noqa: E402
    DEBIAN,
    SOURCE,
    Package,
    Pin,
    Platform,
    Table,
    read_pins,
    requirements_text,
    these_lists,
    this_platform,
)
from refresh_pins import changes, wheel_options  # noqa: E402

TABLE = Table()
PLATFORMS = pytest.mark.parametrize("platform", TABLE.platforms, ids=str)


def lists(platform: Platform) -> dict[str, dict[str, Pin]]:
    """Requirement file -> its pins, for those that are there."""
    return {path.stem: read_pins(path.read_text("utf-8"))
            for path in (ROOT / "dependencies" / str(platform)).glob("requirements*.txt")}


def test_there_is_a_folder_for_each_platform_and_no_other():
    folders = {path.name for path in (ROOT / "dependencies").iterdir() if path.is_dir()}
    assert folders == {str(platform) for platform in TABLE.platforms}


@PLATFORMS
def test_the_lists_are_what_the_table_says(platform):
    wanted = {name: [package.name for package in packages]
              for name, packages in TABLE.requirements(platform).items() if packages}
    assert {name: list(pins) for name, pins in lists(platform).items()} == wanted
    for name in DEBIAN:
        assert TABLE.path(platform, name).read_text("utf-8") == TABLE.debian_text(platform, name)


@PLATFORMS
def test_every_requirement_has_one_version_within_its_limits_and_a_sum(platform):
    limits = {package.name: package.version.get(platform.release, "")
              for packages in TABLE.requirements(platform).values() for package in packages}
    for pins in lists(platform).values():
        for name, pin in pins.items():
            assert pin.version in SpecifierSet(limits[name]), name
            assert pin.hashes and all(len(digest) == 64 for digest in pin.hashes), name


@pytest.mark.parametrize("release", TABLE.data["releases"])
def test_the_architectures_of_a_release_have_the_same_versions(release):
    here = [TABLE.pins(platform) for platform in TABLE.platforms if platform.release == release]
    names = {name for pins in here for name in pins}
    assert not [name for name in names
                if len({pins[name].version for pins in here if name in pins}) > 1]


@PLATFORMS
def test_what_builds_from_source_has_its_compiler(platform):
    debian = TABLE.path(platform, "debian").read_text("utf-8")
    built = lists(platform).get(SOURCE, {})
    assert bool(built) == (str(platform) != "bookworm-amd64")
    assert not built or ("\npython3-dev " in debian and "\ng++ " in debian)


def test_a_requirement_file_is_read_as_it_was_written():
    packages = [Package("a-b", "one"), Package("c", "two")]
    pins = {"a-b": Pin("1.0", ("0" * 64, "1" * 64)), "c": Pin("2", ("2" * 64,))}
    assert read_pins(requirements_text(packages, pins)) == pins


def test_changes_are_told_by_version_and_by_file():
    old = {"a": Pin("1", ("x",)), "b": Pin("1", ("x",)), "c": Pin("1", ("x",)), "e": Pin("1")}
    new = {"a": Pin("2", ("x",)), "b": Pin("1", ("y",)), "d": Pin("1", ("x",)), "e": Pin("1")}
    assert changes(old, new) == ["a: 1 -> 2", "b: 1 as before, another file", "c: gone, was 1",
                                 "d: new, 1"]


def test_pip_is_asked_for_the_wheels_of_the_platform():
    options = wheel_options(TABLE, Platform("bookworm", "arm64"))
    assert "manylinux_2_36_aarch64" in options and "manylinux_2_37_aarch64" not in options
    assert options[options.index("--python-version") + 1] == "3.11"


def test_no_list_names_where_files_come_from():
    for path in (ROOT / "dependencies").rglob("*.txt"):
        assert "://" not in path.read_text("utf-8"), path


def test_this_machine_is_served():
    assert this_platform() in TABLE.platforms and these_lists().is_dir()


def check(tmp_path: Path, os_release: str, architecture: str) -> subprocess.CompletedProcess:
    """check_machine of setup on a machine that says this of itself."""
    (tmp_path / "os-release").write_text(os_release)
    text = (ROOT / "scripts/setup/machine.sh").read_text("utf-8")
    (tmp_path / "machine.sh").write_text(text.replace("/etc/os-release", f"{tmp_path}/os-release"))
    script = (f'fail() {{ echo "$1" >&2; exit 1; }}; dpkg() {{ echo {architecture}; }}; root=$1; '
              '. "$2"; check_machine; echo $platform')
    return subprocess.run(["bash", "-euc", script, "_", ROOT, tmp_path / "machine.sh"],
                          capture_output=True, text=True, check=False)


@PLATFORMS
def test_setup_takes_each_platform(platform, tmp_path):
    done = check(tmp_path, f"ID=debian\nVERSION_CODENAME={platform.release}\n",
                 platform.architecture)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{platform}\n", "")



@pytest.mark.parametrize("architecture", ["armhf", "riscv64", "i386"])
def test_an_architecture_without_builds_is_one_line_with_what_is_missing(architecture, tmp_path):
    done = check(tmp_path, "ID=debian\nVERSION_CODENAME=trixie\n", architecture)
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert architecture in done.stderr and "Numba" in done.stderr
    assert " and ".join(TABLE.data["architectures"]) in done.stderr


def mirror(folder: Path, release: str, versions: dict[str, str], provided: str = "any") -> None:
    """Adds a release to a mirror, as apt reads it: for each architecture these packages."""
    sums = []
    for architecture in TABLE.data["architectures"]:
        path = f"main/binary-{architecture}/Packages"
        file = folder / "dists" / release / path
        file.parent.mkdir(parents=True)
        data = "".join(f"Package: {name}\nArchitecture: all\nVersion: {version}\n"
                       f"Provides: {provided}\n\n" for name, version in versions.items()).encode()
        file.write_bytes(data)
        sums.append(f" {hashlib.sha256(data).hexdigest()} {len(data)} {path}\n")
    (folder / "dists" / release / "Release").write_text(
        f"Codename: {release}\nDate: {formatdate(usegmt=True)}\n"
        f"Architectures: {' '.join(TABLE.data['architectures'])}\n"
        f"Components: main\nSHA256:\n{''.join(sums)}")


def check_releases(folder: Path, release: str) -> subprocess.CompletedProcess:
    """What the command says of a release of that mirror."""
    return subprocess.run(
        [sys.executable, ROOT / "scripts/check_releases.py", release, "--source",
         f"deb [trusted=yes] file:{folder} {{}} main"], capture_output=True, text=True, check=False)


def test_a_release_is_compared_with_what_our_newest_takes(tmp_path):
    newest = list(TABLE.data["releases"])[-1]
    ours = {package.name: "1:2.9-1" for kind in DEBIAN
            for packages in TABLE.sections(kind).values() for package in packages}
    mirror(tmp_path, newest, ours | {"python3": "3.13.5-1"})
    new = ours | {"python3": "3.14.0-1", "rosbash": "1:3.0-1", "ros-environment": "1:2.10~rc1-1"}
    mirror(tmp_path, "next", {name: version for name, version in new.items()
                              if name not in ("libx11-dev", "ros-core", "rviz", "graphviz")},
           provided="graphviz")
    done = check_releases(tmp_path, "next")
    (why,) = [each.why for each in TABLE.sections("debian")["building"]
              if each.name == "libx11-dev"]
    (rviz,) = [each.why for each in TABLE.sections("debian")["testing"] if each.name == "rviz"]
    assert done.stdout.splitlines() == [
        f"next: missing: rviz ({rviz})", "next: changed: Python 3.13 -> 3.14",
        "next: changed: rosbash 2 -> 3", f"next: missing: libx11-dev ({why}), arm64 alone"]
    assert (done.returncode, done.stderr) == (1, "")
    done = check_releases(tmp_path, newest)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"{newest} has all that our lists for {newest} take\n"


def test_a_release_that_is_not_there_is_one_line(tmp_path):
    mirror(tmp_path, list(TABLE.data["releases"])[-1], {"python3": "3.13.5-1"})
    done = check_releases(tmp_path, "wrody")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("check_releases: wrody: ") and done.stderr.count("\n") == 1


def test_a_release_that_only_adds_to_another_is_one_line(tmp_path):
    mirror(tmp_path, list(TABLE.data["releases"])[-1], {"python3": "3.13.5-1"})
    mirror(tmp_path, "backports", {"cmake": "3.31.6-1"})
    done = check_releases(tmp_path, "backports")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == ("check_releases: backports: is no whole release, as it has no python3; "
                           "name one, such as testing\n")


def test_ros_is_taken_in_parts_that_the_next_release_has_too():
    """Debian 14 has no ros-core, which only depends on these."""
    names = {package.name for packages in TABLE.sections("debian").values() for package in packages}
    assert "ros-core" not in names
    assert {"python3-rosmaster", "python3-roslaunch", "python3-rostopic", "rosout"} <= names
