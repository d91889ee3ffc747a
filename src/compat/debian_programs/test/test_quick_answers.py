"""What rosrun and roscore ask of catkin_find and rosversion: Debian's answers, without Python."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[4]
DEBIANS = "/usr/bin/catkin_find"
ROSRUN = (["--without-underlays", "--libexec", "--share"], ["--without-underlays", "--share"])
PACKAGES = ["above", "both", "below", "installed", "stale", "no_package", "tf"]


@pytest.fixture(scope="module")
def terminal(tmp_path_factory) -> dict[str, str]:
    """Of a workspace with a space in its name, above another one and an installed one."""
    folder = tmp_path_factory.mktemp("work spaces")
    sources = {"top": ["above", "both", "group/nested"], "under": ["both", "below"]}
    for name, packages in sources.items():
        for path in packages:
            home = folder / name / "src" / path
            home.mkdir(parents=True)
            (home / "package.xml").write_text(
                f'<package format="2"><name>{home.name}</name><version>0.0.0</version>'
                "<description>a</description><maintainer email='a@b.com'>a</maintainer>"
                "<license>MIT</license></package>")
            (folder / name / "devel/lib" / home.name).mkdir(parents=True)
        (folder / name / "devel/.catkin").write_text(str(folder / name / "src"))
    (folder / "top/devel/lib/stale").mkdir()  # its source has gone
    (folder / "top/devel/lib/tf").mkdir()  # a program of ours under the name of Debian's package
    for path in ("lib", "share"):
        (folder / "install" / path / "installed").mkdir(parents=True)
    (folder / "install/.catkin").touch()
    (folder / "no workspace/lib/above").mkdir(parents=True)
    prefixes = ["no workspace", "top/devel", "under/devel", "install"]
    return os.environ | {
        "CMAKE_PREFIX_PATH": ":".join(str(folder / each) for each in prefixes),
        "ROS_PACKAGE_PATH": ":".join([*(f"{folder}/{each}" for each in (
            "top/src", "under/src", "install/share")), "/usr/share"]),
        "ROS_HOME": str(folder / "ros")}


def answer(program: str, words: list[str], terminal: dict[str, str]) -> tuple[int, str]:
    done = subprocess.run([program, *words], env=terminal, text=True, stdout=subprocess.PIPE)
    return done.returncode, done.stdout


@pytest.mark.parametrize("words", [*([*asked, package] for asked in ROSRUN for package in (
    *PACKAGES, "nested", "roscpp")), ["above"], ["--share", "both", "package.xml"],
    ["--first-only", "no_package"], ["--without-underlays", "--share", "--first-only", "both"],
    ["--without-underlays", "--share", "--help"], ["--without-underlays", "--share", "--lib"]],
    ids=" ".join)
def test_the_answer_is_debians(terminal, words):
    wanted = answer(DEBIANS, words, terminal)
    assert answer(shutil.which("catkin_find"), words, terminal) == wanted
    if words[-1] in ("above", "both", "nested"):
        assert wanted[1].count("\n") >= 1


def test_what_rospack_does_not_know_debians_finds(terminal):
    words, unknown = [*ROSRUN[1], "above"], terminal | {"ROS_PACKAGE_PATH": ""}
    wanted = answer(DEBIANS, words, unknown)
    assert wanted[1] and answer(shutil.which("catkin_find"), words, unknown) == wanted


@pytest.mark.parametrize("words", [["-d"], ["roslaunch"], ["rospy"], ["no_package"], []],
                         ids=" ".join)
@pytest.mark.parametrize("distro", ["Debian", "", None])
def test_a_version_is_debians(words, distro):
    terminal = {name: text for name, text in os.environ.items() if name != "ROS_DISTRO"}
    terminal |= {} if distro is None else {"ROS_DISTRO": distro}
    wanted = answer("/usr/bin/rosversion", words, terminal)
    assert answer(shutil.which("rosversion"), words, terminal) == wanted


@pytest.mark.parametrize(("program", "words"), [
    ("catkin_find", [*ROSRUN[0], "both"]), ("catkin_find", [*ROSRUN[1], "both"]),
    ("catkin_find", [*ROSRUN[0], "tf"]),
    ("rosversion", ["-d"]), ("rosversion", ["roslaunch"])], ids=str)
def test_ours_is_asked_and_starts_no_python(terminal, program, words):
    found = shutil.which(program)
    assert Path(found).resolve() == ROOT / "src/compat/debian_programs/bin" / program
    asked = subprocess.run(["bash", "-x", found, *words], env=terminal, text=True,
                           stderr=subprocess.PIPE, stdout=subprocess.DEVNULL).stderr
    assert asked and f"/usr/bin/{program}" not in asked
