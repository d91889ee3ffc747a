"""What tools/makers makes is what is committed or built; of pictures the pixels are compared."""

import importlib
import runpy
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

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
