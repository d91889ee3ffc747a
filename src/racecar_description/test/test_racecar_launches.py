"""What race, mapping and navigation.launch set: nodes, files, and that each parameter is known."""

import math
from pathlib import Path

import pytest
import yaml
from racecar_in_world import PACKAGE
from roslaunch.config import ROSLaunchConfig, load_config_default
from roslaunch.xmlloader import XmlLoader

from map_server.map_files import read_map

NAVIGATION = PACKAGE.parent / "navigation"
COSTMAP = ("costmap", "static_layer", "obstacle_layer", "inflation_layer")


def load(name, *arguments):
    config = ROSLaunchConfig()
    XmlLoader().load(str(PACKAGE / "launch" / f"{name}.launch"), config,
                     argv=["car:=false", *arguments], verbose=False)
    return ({node.name: node for node in config.nodes},
            {key: param.value for key, param in config.params.items()})


def table(package, name):
    text = (NAVIGATION / package / "params" / f"{name}.yaml").read_text(encoding="utf-8")
    return {row["name"] for row in yaml.safe_load(text)}


@pytest.fixture(autouse=True)
def no_screen(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)


def test_nodes(monkeypatch):
    assert set(load("mapping")[0]) == {"wheel_odometry", "slam_gmapping"}
    nodes, _ = load("navigation")
    assert set(nodes) == {"wheel_odometry", "map_server", "amcl", "move_base"}
    assert Path(nodes["map_server"].args).is_file()
    monkeypatch.setenv("DISPLAY", ":0")
    for name in ("mapping", "navigation"):
        rviz = load(name)[0]["rviz"]
        assert Path(rviz.args.split()[1]).is_file() and not rviz.required


def test_the_car_starts_where_amcl_thinks_it_does():
    _, values = load("navigation", "x_pos:=1.5", "yaw:=0.5")
    pose = [values[f"/amcl/initial_pose_{axis}"] for axis in "xya"]
    assert pose == [1.5, 0.0, 0.5]


def test_amcl_stays_with_the_place_where_the_car_was_put():
    """Between two walls random particles found a likely place elsewhere, facing backwards."""
    _, values = load("navigation")
    assert values["/amcl/recovery_alpha_slow"] == values["/amcl/recovery_alpha_fast"] == 0.0
    assert max(values[f"/amcl/initial_cov_{axis}"] for axis in ("xx", "yy", "aa")) <= 0.01


def test_parameters_are_known():
    known = {
        "/slam_gmapping/": table("gmapping", "slam_gmapping"), "/amcl/": table("amcl", "amcl"),
        "/move_base/": table("move_base", "move_base"),
        "/move_base/HybridAStar/": table("move_base", "hybrid_astar"),
        "/move_base/PurePursuit/": table("move_base", "pure_pursuit"),
        "/move_base/escape/": table("move_base", "escape_recovery"),
        "/move_base/aggressive_reset/": table("move_base", "clear_costmap_recovery"),
        "/move_base/local_costmap/": set().union(*(table("costmap_2d", name) for name in COSTMAP)),
        "/move_base/local_costmap/scan/": table("costmap_2d", "source"),
    }
    known |= {space.replace("local", "global"): names for space, names in known.items()}
    for name in load("mapping")[1] | load("navigation")[1]:
        space, _, last = name.rpartition("/")
        if space and space != "/motor_control":
            assert last in known[f"{space}/"], name


def test_the_car_can_drive_what_is_planned():
    """Of bends the steering leaves a little to the follower, and that to the planner."""
    _, values = load("navigation")
    angle = values["/motor_control/max_steering_angle"]
    tightest = values["/move_base/wheelbase"] / math.tan(angle)  # m
    radii = [values[f"/move_base/{name}/minimum_turning_radius"]
             for name in ("PurePursuit", "HybridAStar")]
    assert tightest < radii[0] < radii[1]



def test_the_map_is_the_field_within_the_walls():
    grid, _ = read_map(PACKAGE / "maps" / "racetrack.yaml")
    free = (grid.cells == 0).sum() * grid.resolution ** 2
    assert free == pytest.approx(12.0 * 8.0, rel=0.02)
    assert grid.cells[tuple(grid.cells_of([(0.0, 0.0)])[0])] == 0


BRAKES = 8.0  # m/s^2, measured: from 2.2 m/s in 0.28 s
STANDS = 0.7  # s, after the last command
ARRIVES = 0.04  # s, until that command moves the wheels


@pytest.mark.parametrize("lockstep, rate_hz", [("", None), ("/motor_output", 0.0)])
def test_a_car_whose_follower_hangs_stands_in_time_at_its_greatest_speed(lockstep, rate_hz):
    file = str(PACKAGE / "launch" / "race.launch")
    config = load_config_default([(file, [f"lockstep:={lockstep}"])], None, verbose=False)
    values = {name: param.value for name, param in config.params.items()}
    settings = PACKAGE.parent / "car_control" / "config" / "lane_follow.yaml"
    fastest = yaml.safe_load(settings.read_text(encoding="utf-8"))["max_speed"]
    assert values["/motor_control/timeout"] + fastest / BRAKES + ARRIVES <= STANDS
    assert values.get("/motor_control/rate_hz") == rate_hz
