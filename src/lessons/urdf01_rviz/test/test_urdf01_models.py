"""The models are sound URDF with the links, joints and sizes that the lesson names."""

import math
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

PACKAGE = Path(__file__).resolve().parents[1]
CAR = PACKAGE / "urdf" / "xacro" / "demo05_car.urdf.xacro"
PLAIN = sorted((PACKAGE / "urdf").glob("*.urdf"))
WHOLE = sorted((PACKAGE / "urdf" / "xacro").glob("demo*"))


def expanded(path):
    if path.suffix != ".xacro":
        return path.read_text(encoding="utf-8")
    done = subprocess.run(["rosrun", "xacro", "xacro", str(path)], check=True, text=True,
                          capture_output=True)
    return done.stdout


def joints(path):
    return {joint.get("name"): (joint.get("type"), joint.find("origin").get("xyz"))
            for joint in ElementTree.fromstring(expanded(path)).findall("joint")}


@pytest.mark.parametrize("path", [*PLAIN, *WHOLE], ids=lambda path: path.name)
def test_check_urdf_takes_it(path, tmp_path):
    file = tmp_path / "model.urdf"
    file.write_text(expanded(path), encoding="utf-8")
    done = subprocess.run(["check_urdf", str(file)], text=True, capture_output=True, check=False)
    assert done.returncode == 0 and "Successfully Parsed XML" in done.stdout, done.stdout


@pytest.mark.parametrize("path", sorted((PACKAGE / "launch").glob("*")), ids=lambda path: path.name)
def test_without_a_screen_no_rviz_is_started(path):
    done = subprocess.run(["env", "-u", "DISPLAY", "roslaunch", "--nodes", str(path)], text=True,
                          capture_output=True, check=True)
    nodes = done.stdout.split()
    assert "/robot_state_publisher" in nodes and "/rviz" not in nodes


def test_the_car_stands_on_the_ground():
    found = joints(CAR)
    assert found["left_wheel2base_link"][0] == found["right_wheel2base_link"][0] == "continuous"
    def height(name):
        return float(found[name][1].split()[2])
    base = height("base_link2base_footprint")
    assert base + height("left_wheel2base_link") == pytest.approx(0.0325)  # the wheel's radius
    assert base + height("front_wheel2base_link") == pytest.approx(0.0075)


def test_the_mesh_is_closed_and_as_large_as_told():
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("unused", "<u2")])
    data = (PACKAGE / "meshes" / "autolabor_mini.stl").read_bytes()
    triangles = np.frombuffer(data, facet, offset=84)["corners"].astype(float)
    # Each edge has a triangle on either side, so all solids are closed.
    edges = [(tuple(p), tuple(q)) for a, b, c in triangles for p, q in ((a, b), (b, c), (c, a))]
    assert sorted(edges) == sorted((q, p) for p, q in edges)
    volume = sum(np.linalg.det(triangle) for triangle in triangles) / 6  # of outward faces: > 0
    wheel = 12 * math.sin(math.tau / 24) * 0.05**2 * 0.03
    assert volume == pytest.approx(0.15 * 0.10 * 0.30 + 4 * wheel)
    assert min(y for triangle in triangles for _x, y, _z in triangle) == pytest.approx(0.0)
