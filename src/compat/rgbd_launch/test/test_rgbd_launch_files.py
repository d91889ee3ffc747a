"""What the files start, and with which switches."""

from pathlib import Path

import pytest
import roslaunch
from roslaunch.config import load_config_default

INCLUDES = Path(__file__).resolve().parent.parent / "launch" / "includes"


def nodes(file, **arguments):
    words = [f"{key}:={value}" for key, value in arguments.items()]
    files = roslaunch.rlutil.resolve_launch_arguments([str(INCLUDES / f"{file}.launch.xml")])
    config = load_config_default([(files[0], words)], None, verbose=False)
    return {node.name: node for node in config.nodes}


def test_all_of_a_camera():
    found = nodes("processing", manager="m")
    assert len(found) == 18
    assert all(node.args.startswith(("load image_proc/", "load depth_image_proc/"))
               and node.args.split()[2:] == ["m", "--no-bond"] for node in found.values())
    points = found["depth_points"]
    assert ["image_rect", "depth/image_rect_raw"] in points.remap_args
    assert ["points", "depth/points"] in points.remap_args


@pytest.mark.parametrize("part, count", [("rgb", 3), ("ir", 1), ("depth", 4), ("disparity", 1),
                                         ("depth_registered", 7), ("disparity_registered", 2)])
def test_each_part_can_be_switched_off(part, count):
    assert len(nodes("processing", manager="m", **{f"{part}_processing": "false"})) == 18 - count


def test_manager():
    (manager,) = nodes("manager", name="m", num_worker_threads=4).values()
    assert (manager.name, manager.args) == ("m", "manager")
