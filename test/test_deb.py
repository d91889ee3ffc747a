"""What `make deb` tells dpkg, and what it packs of PyPI's packages; it is not made here."""

import re
import sys
from pathlib import Path

import pytest

from bullet_sim import __version__

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = (ROOT / "dependencies/bookworm-amd64/debian.txt").read_text(encoding="utf-8")


@pytest.fixture
def deb(monkeypatch):
    """scripts/deb_control.py and scripts/deb_stage.py as modules."""
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    import deb_control
    import deb_stage
    return deb_control, deb_stage


def test_dependencies_come_from_the_list(deb):
    depends, recommends = deb[0].dependencies(PACKAGES)
    assert {"rosout", "python3-rospy", "libgeometry-msgs-dev", "ffmpeg"} <= set(depends)
    assert {"catkin", "g++", "ros-message-generation"} <= set(recommends)
    listed = {line.partition("#")[0].strip() for line in PACKAGES.splitlines()} - {""}
    assert {*depends, *recommends} < listed
    assert not {"xvfb", "chromium", "python3-rostest"} & {*depends, *recommends}
    assert not set(depends) & set(recommends)


def test_a_renamed_section_is_told(deb):
    with pytest.raises(ValueError, match="no section testing"):
        deb[0].dependencies(PACKAGES.replace("# testing", "# tests"))


def test_a_comment_within_a_section_begins_none(deb):
    assert deb[0].sections("# head\n\n# a\none\n# about two\ntwo  # why\n\n# b\nthree\n") == {
        "a": ["one", "two"], "b": ["three"]}


def test_control_file(deb):
    text = deb[0].control("/opt/ros/courses", "1.0+2", "amd64", 7, PACKAGES)
    fields = dict(re.findall(r"^([\w-]+): (.*)$", text, re.MULTILINE))
    assert {"Package", "Version", "Architecture", "Maintainer", "Depends", "Description",
            "Installed-Size"} <= fields.keys()
    assert fields["Installed-Size"] == "7"
    minor = sys.version_info.minor
    assert f"python3 (>= 3.{minor}), python3 (<< 3.{minor + 1})" in fields["Depends"]
    assert all(line.startswith(" ") for line in text.split("Description: ")[1].splitlines()[1:])
    assert text.endswith("\n")


def test_versions_grow_with_time_and_are_dpkgs(deb):
    earlier, later = deb[0].version(1_000_000_000), deb[0].version(1_000_000_060)
    assert earlier < later and later.startswith(f"{__version__}+")
    assert re.fullmatch(r"[0-9][A-Za-z0-9.+~]*\+deb1[23]", later)


def test_each_required_package_travels(deb):
    stage = deb[1]
    names = {package.metadata["Name"].lower() for package in stage.required()}
    assert {"pybullet", "numba", "opencv-python-headless", "moderngl"} <= names
    for package in stage.required():
        files = list(stage.travelling_files(package))
        assert any(file.suffix in (".py", ".so") for file in files), package.metadata["Name"]
        assert not [file for file in files if ".." in file.parts or "pybullet_data" in file.parts]


def test_the_folder_of_the_build_is_found_where_it_is_named(deb, tmp_path):
    stage = deb[1]
    (tmp_path / "script").write_text(f"#!{ROOT}/.venv/bin/python3\n")
    (tmp_path / "other").write_text(f"see {ROOT}/src\n")
    stage.settle_interpreter(tmp_path, "/opt/ros/courses")
    assert (tmp_path / "script").read_text() == "#!/opt/ros/courses/bin/python3\n"
    assert stage.places_of_build(tmp_path) == [tmp_path / "other"]
