"""What tools/makers makes is what is committed or built; of pictures the pixels are compared."""

import importlib
import runpy
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from run_session.failure import RunError

ROOT = Path(__file__).resolve().parent.parent
TOOL = ROOT / "tools/makers"
sys.path.append(str(TOOL))
MAKERS = runpy.run_path(str(TOOL / "__main__.py"))["MAKERS"]


def pixels(data: bytes) -> np.ndarray:
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)


@pytest.mark.parametrize("name", MAKERS)
def test_what_is_there_is_what_is_made(name):
    made = importlib.import_module(name).files()
    assert made
    for path, data in made.items():
        committed = (ROOT / path).read_bytes()
        if path.endswith(".png"):  # libraries compress in different ways
            assert np.array_equal(pixels(committed), pixels(data)), f"tools/makers {name}: {path}"
        else:
            assert committed == data, f"tools/makers {name}: {path}"


def test_each_mesh_of_the_turtlebots_is_made_here():
    meshes = ROOT / "src/compat/turtlebot3_description/meshes"
    there = {str(path.relative_to(ROOT)) for path in meshes.rglob("*") if path.is_file()}
    assert there == importlib.import_module("turtlebot3_meshes").files().keys()


def ran(*words):
    return subprocess.run([sys.executable, TOOL, *words], capture_output=True, text=True,
                          check=False)


def test_the_command_lists_them_and_writes_elsewhere(tmp_path):
    listed = ran()
    assert listed.returncode == 0
    assert [line.split()[0] for line in listed.stdout.splitlines()] == list(MAKERS)
    assert ran("urdf_lesson_mesh", "--out", tmp_path).returncode == 0
    mesh = "src/lessons/urdf01_rviz/meshes/autolabor_mini.stl"
    assert (tmp_path / mesh).read_bytes() == (ROOT / mesh).read_bytes()


def test_a_folder_that_cannot_be_made_is_one_line():
    done = ran("urdf_lesson_mesh", "--out", "/dev/null/meshes")
    assert done.returncode == 1
    assert done.stderr.startswith("makers: /dev/null/meshes/src/lessons/") and (
        len(done.stderr.splitlines()) == 1)


def test_what_is_as_it_was_is_not_made_again(tmp_path):
    kept = importlib.import_module("kept")
    made, folder = tmp_path / "a.world", tmp_path / "made"
    assert not kept.is_made("worlds", folder)
    made.write_text("a")
    kept.keep("worlds", [made, tmp_path], folder)
    kept.keep("worlds", [made, tmp_path], folder)  # the folder has its own folder now
    assert kept.is_made("worlds", folder)
    made.write_text("ab")
    assert not kept.is_made("worlds", folder)
    kept.keep("worlds", [made, tmp_path], folder)
    (tmp_path / "new").touch()
    assert not kept.is_made("worlds", folder)
    kept.keep("worlds", [made], folder)
    made.unlink()
    assert not kept.is_made("worlds", folder)
    (folder / "worlds.json").write_text("[")
    assert not kept.is_made("worlds", folder)


@pytest.mark.parametrize("name", ["name_packages", "turtlebot3_worlds"])
def test_what_setup_makes_each_time_is_left_out_the_second_time(name):
    assert ran(name).returncode == 0
    second = subprocess.run([sys.executable, "-X", "importtime", TOOL, name], text=True,
                            capture_output=True, check=True)
    assert "kept" in second.stderr and "numpy" not in second.stderr and "yaml" not in second.stderr


@pytest.fixture
def names(tmp_path, monkeypatch):
    """The maker of packages that are only a name, in a repository of one table."""
    maker = importlib.import_module("name_packages")
    monkeypatch.setattr(maker, "ROOT", tmp_path)
    (tmp_path / "src/compat").mkdir(parents=True)

    def write(text):
        (tmp_path / "src/compat/names.yaml").write_text(text)
        return maker

    return write


def test_a_name_is_a_package_with_what_it_hands_on_and_what_does_its_work(names):
    made = names("[{description: a < b, build: [c], run: [d], names: {n: 1.2.3}}]").files()
    package, cmake = (data.decode() for data in made.values())
    assert list(made) == [f"src/compat/names/n/{file}" for file in ("package.xml",
                                                                    "CMakeLists.txt")]
    assert "<name>n</name>" in package and "<version>1.2.3</version>" in package
    assert "a &lt; b" in package
    assert "<depend>c</depend>\n  <exec_depend>d</exec_depend>" in package
    assert "COMPONENTS c)\ncatkin_package(CATKIN_DEPENDS c)" in cmake


def test_a_folder_whose_name_is_gone_is_stale(names, tmp_path):
    for folder in ("old", "n"):
        (tmp_path / "src/compat/names" / folder).mkdir(parents=True)
    maker = names("[{description: a, names: {n: 1.2.3}}]")
    assert maker.stale() == [tmp_path / "src/compat/names/old"]


def test_a_learners_own_table_is_left_alone(names, tmp_path):
    own = tmp_path / "src/my_detector"
    (own / "names/person").mkdir(parents=True)
    (own / "names.yaml").write_text("person: 1")
    maker = names("[{description: a, names: {n: 1.2.3}}]")
    assert len(maker.files()) == 2 and maker.stale() == []


@pytest.mark.parametrize(("text", "said"), [
    ("[{description: a, nmes: {n: 1.2.3}}]", "unknown key 'nmes'"),
    ("[{description: a, names: {n: 1.2}}]", "names: must be upstream's version by package"),
    ("[{description: a, names: {n: 1.2.3}}, {description: b, names: {n: 1.2.3}}]", "n stands"),
    ("a: b", "must be a list of groups of names"), ("[a]", "must be a list of groups of names")])
def test_a_wrong_table_is_one_line(names, text, said):
    with pytest.raises(RunError, match=f"src/compat/names.yaml: {said}"):
        names(text).files()
