"""`rosdep` as it is typed, with an empty home and no network, and apt's answers."""

import importlib.util
import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from workspace_needs.places import release
from workspace_needs.rosdep_command import Watch
from workspace_needs.tables import Tables
from workspaces import add_package, turtlebot3_style

from workspace_needs import apt

ROSDEP = Path(__file__).resolve().parents[1] / "scripts/rosdep"


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """It is empty at first: one cache is made for all tests."""
    return tmp_path_factory.mktemp("home")


@pytest.fixture
def rosdep(tmp_path, home, monkeypatch):
    """Runs it; exit code, output and errors."""
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("ROS_DISTRO", "Debian")
    for name in ("http_proxy", "https_proxy"):  # at a closed port: what asks the network fails
        monkeypatch.setenv(name, "http://127.0.0.1:9")
    for name in ("ROS_HOME", "ROSDEP_SOURCE_PATH", "ROSDISTRO_INDEX_URL"):
        monkeypatch.delenv(name, raising=False)

    def run(*words: str) -> tuple[int, str, str]:
        done = subprocess.run([sys.executable, str(ROSDEP), *words], capture_output=True, text=True,
                              cwd=tmp_path, timeout=60, check=False)
        return done.returncode, done.stdout, done.stderr
    return run


def test_without_init_update_and_network(rosdep, tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert rosdep("resolve", "roscpp")[1].split()[:2] == ["#apt", "libroscpp-dev"]
    assert rosdep("resolve", "bullet_sim_ros")[0] == 0
    code, said, _ = rosdep("update")
    assert code == 0 and "no network is needed" in said and said.count("\n") == 1
    assert rosdep("init")[0] == 0
    code, _, said = rosdep("resolve", "moveit_core")
    assert code == 1 and "MoveIt is not in Debian" in said
    assert [path.name for path in (tmp_path / "home/.ros").iterdir()] == ["rosdep-courses"]


def of_one_release():
    """A key that this release lacks, and the line about it."""
    tables = Tables()
    lacking = [key for key, rule in tables.debian.items()
               if rule["debian"].get(release()) is None and "-" not in key]
    return lacking[0], tables.answer(lacking[0]).why


def test_a_key_that_only_the_other_release_has(rosdep, tmp_path):
    key, why = of_one_release()
    assert re.fullmatch(r"Debian 1\d has it, Debian 1\d does not", why)
    assert rosdep("resolve", key) == (1, "", f"rosdep: {key}: {why}\n")
    code, said, errors = rosdep("resolve", "--rosdistro", "noetic", "roscpp", key)
    assert (code, errors) == (1, f"rosdep: {key}: {why}\n") and "libroscpp-dev" in said
    add_package(tmp_path / "src", "eye", f"roscpp {key}")
    for command in (("install", "-y", "-s"), ("check",)):
        _, out, said = rosdep(*command, "--from-paths", "src", "--ignore-src")
        assert "satisfied" not in out
        assert said == f"rosdep: {key} (dependency of eye): {why}\n"


@pytest.mark.parametrize("key, of_release, why", [
    ("compressed_image_transport", "bookworm", "Debian 13 has it, Debian 12 does not"),
    ("python_qt_binding", "trixie", "Debian 12 has it, Debian 13 does not")])
def test_who_has_a_key_of_one_release(key, of_release, why):
    assert Tables(of_release=of_release).answer(key).why == why


@pytest.mark.parametrize("distro", [(), ("--rosdistro", "noetic"), ("--rosdistro=melodic",)])
def test_install_of_a_workspace_like_turtlebot3s(rosdep, tmp_path, distro):
    turtlebot3_style(tmp_path)
    code, said, errors = rosdep("install", "--from-paths", "src", "--ignore-src", "-y", "-s",
                                *distro)
    assert (code, errors) == (0, "")
    assert said == "" or said.startswith("#[apt] Installation commands:\n")


def test_what_nobody_has_does_not_stop_it_and_a_mistyped_key_is_named(rosdep, tmp_path):
    add_package(tmp_path / "src", "arm", "moveit_core roscpp")
    words = ("install", "--from-paths", "src", "--ignore-src", "-y", "-s")
    code, _, said = rosdep(*words)
    assert code == 0
    assert said.startswith("rosdep: moveit_core (dependency of arm): MoveIt is not in Debian")
    add_package(tmp_path / "src", "wheel", "rospyy")
    code, _, said = rosdep(*words)
    assert code == 1 and said.count("\n") == 2
    assert ("rosdep: rospyy (dependency of wheel): nobody has that name; is rospy meant?" in said)


def test_no_success_is_told_where_a_key_is_mistyped(rosdep, tmp_path, monkeypatch):
    monkeypatch.setenv("LC_ALL", "zh_CN.UTF-8")
    add_package(tmp_path / "src", "pkg2", "rospyy")
    words = ("--from-paths", "src", "--ignore-src")
    line = "rosdep: rospyy（pkg2 依赖它）：没有叫这个名字的包；是不是想写 rospy？\n"
    assert rosdep("install", *words, "-y") == (1, "", line)
    assert rosdep("check", *words) == (1, "", line)


def test_robust_skipped_keys_and_a_folder_called_install(rosdep, tmp_path):
    add_package(tmp_path / "src", "wheel", "rospyy")
    add_package(tmp_path / "install", "wheel", "rospyy")
    words = ("install", "--from-paths", "src", "--ignore-src", "-y", "-s")
    assert rosdep(*words, "-r")[0] == 0
    assert rosdep(*words, "--skip-keys", "rospyy")[::2] == (0, "")


def test_a_package_xml_that_cannot_be_read_is_one_line(rosdep, tmp_path):
    (add_package(tmp_path / "src", "wheel") / "package.xml").write_text("<package>")
    code, said, errors = rosdep("install", "--from-paths", "src", "--ignore-src", "-y", "-s")
    assert (code, said, errors.count("\n")) == (1, "", 1)
    assert errors.startswith("rosdep: src/wheel/package.xml: The manifest contains invalid XML")


def test_nothing_is_installed_without_a_yes(monkeypatch):
    monkeypatch.setattr(apt, "install", pytest.fail)
    watch = Watch(Tables())
    for answer in ("", "n\n"):
        monkeypatch.setattr(sys, "stdin", io.StringIO(answer))
        assert watch._install(["apt-get", "install", "libno-dev"]) == 1
        assert watch.failure.startswith("nothing was installed")


OFFLINE = "Err:1 http://deb.debian.org\n  Could not connect to 127.0.0.1:9\nE: Failed to fetch x\n"
UNKNOWN = "E: Unable to locate package libno-dev\n"


@pytest.mark.parametrize("answers, words", [
    ([(100, OFFLINE)], "no network: apt cannot fetch the packages; connect and run this again"),
    ([(100, UNKNOWN), (0, OFFLINE)], "no network: apt cannot fetch"),
    ([(100, UNKNOWN), (0, ""), (100, UNKNOWN)], "apt knows no package libno-dev"),
    ([(100, "E: dpkg was interrupted\n")], "apt-get failed: dpkg was interrupted"),
])
def test_apt_says_in_a_line_what_is_wrong(monkeypatch, answers, words):
    left = iter(answers)
    monkeypatch.setattr(apt, "_run", lambda command: next(left))
    with pytest.raises(apt.AptError, match=words):
        apt.install(["libno-dev"])


def test_apts_lists_are_read_again_once_they_have_changed(tmp_path, monkeypatch):
    lists, command = tmp_path / "lists", tmp_path / "apt-cache"
    lists.write_text("liba-dev")
    os.utime(lists, (1, 1))
    command.write_text(f"#!/bin/sh\ncat {lists}\n")
    command.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    monkeypatch.setenv("ROS_HOME", str(tmp_path / "ros"))
    monkeypatch.setattr(apt, "SOURCES", (lists,))
    for changed, names in ((1, "liba-dev"), (1, "liba-dev"), (2e9, "libb-dev")):
        os.utime(lists, (changed, changed))
        apt.names.cache_clear()
        assert apt.names() == {names}
        lists.write_text("libb-dev")
    apt.names.cache_clear()


def test_neither_root_nor_sudo(monkeypatch):
    monkeypatch.setattr(apt.os, "geteuid", lambda: 1000)
    monkeypatch.setattr(apt.shutil, "which", lambda name: None)
    with pytest.raises(apt.AptError, match="you are not root and there is no sudo"):
        apt.install(["libno-dev"])


def test_what_rospkg_imports_is_no_rosdep():
    """It would ask rosdep about every package.xml, and complain in each home without its cache."""
    found = importlib.util.find_spec("rosdep2")  # Debian's own may be there
    assert found is None or not found.origin.startswith(sys.prefix)
