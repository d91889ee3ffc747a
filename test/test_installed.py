"""`catkin_make install` installs each package completely; installed.yaml says what that means."""

import os
import re
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
SRC, BUILD = ROOT / "src", ROOT / "build"
RULES = yaml.safe_load((Path(__file__).parent / "installed.yaml").read_text(encoding="utf-8"))
# A module that looks for files this way finds others when it is installed.
BY_SOURCE_TREE = re.compile(r"__file__\)[^\n]*(parents\[[2-9]\]|parent\.parent\.parent)")


def sources() -> list[Path]:
    """Files below src/ that belong to the repository, its packages' links included."""
    listed = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files", "-z", "--cached", "--others", "--exclude-standard",
         "src"], capture_output=True, check=True).stdout
    paths = [ROOT / os.fsdecode(name) for name in listed.split(b"\0") if name]
    paths += (SRC / "compat/turtlebot3_gazebo/worlds").iterdir()  # which the build makes
    return sorted(path for path in paths if path.is_file())


def packages() -> dict[Path, str]:
    """Folder -> name of each package."""
    return {manifest.parent: ET.parse(manifest).findtext("name")
            for manifest in SRC.rglob("package.xml") if "test" not in manifest.parts}


def expected(file: Path, folder: Path, name: str) -> list[str] | None:
    """Paths of which one must be in the install space; None: left out."""
    path, package = file.relative_to(SRC).as_posix(), re.escape(
        folder.relative_to(SRC).as_posix())
    for rule in RULES:
        if found := re.fullmatch(rule["match"].replace("PACKAGE", package), path):
            places = rule.get("at")
            return places and [at.format(package=name, **found.groupdict()) for at in places]
    raise AssertionError(f"installed.yaml has no rule for {path}")


@pytest.fixture(scope="module")
def space(tmp_path_factory):
    """The install space of the built workspace."""
    if not (BUILD / "cmake_install.cmake").exists():
        pytest.skip("nothing is built here: make build")
    stage = tmp_path_factory.mktemp("stage")
    done = subprocess.run(["cmake", "--install", str(BUILD)], capture_output=True, text=True,
                          env={**os.environ, "DESTDIR": str(stage)}, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return next(stage.rglob("_setup_util.py")).parent


def test_each_file_is_installed(space):
    folders, missing = packages(), []
    for file in sources():
        folder = next((parent for parent in file.parents if parent in folders), None)
        places = folder and expected(file, folder, folders[folder])
        if places and not any((space / place).is_file() for place in places):
            missing.append(f"{file.relative_to(ROOT)} is at none of {', '.join(places)}")
        elif places:
            found = next(space / place for place in places if (space / place).is_file())
            if os.access(file, os.X_OK) and not os.access(found, os.X_OK):
                missing.append(f"{file.relative_to(ROOT)}: installed, but cannot be run")
    assert not missing, "\n".join(missing)


def test_nothing_of_the_tests_is_installed(space):
    names = {path.name for path in sources() if "/test/test_" in path.as_posix()}
    assert not [path for path in space.rglob("test_*.py") if path.name in names]


def test_each_package_is_found(space):
    there = {path.parent.name for path in space.glob("share/*/package.xml")}
    assert set(packages().values()) <= there


def test_no_module_looks_for_files_in_the_source_tree():
    found = [str(path.relative_to(ROOT)) for path in sources()
             if path.suffix == ".py" and re.search(r"/src/.*/src/|^src/[^/]+/src/",
                                                   path.relative_to(ROOT).as_posix())
             and BY_SOURCE_TREE.search(text := path.read_text(encoding="utf-8"))
             and "RosPack" not in text]
    assert not found, f"use rospkg.RosPack().get_path: {', '.join(found)}"
