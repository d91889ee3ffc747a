"""The worlds that are made here: same bytes each time, upstream's numbers, and nobody falls."""

import math
import re
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.xacro.files import expand
from bullet_sim.pose import Pose
from bullet_sim.world import World
from bullet_sim_ros.package_paths import open_resources

PACKAGE = Path(__file__).resolve().parent.parent
ROOT = PACKAGE.parents[2]
sys.path.append(str(ROOT / "tools/makers"))
import turtlebot3_worlds  # noqa: E402
from painting import RED, WHITE, YELLOW, Canvas  # noqa: E402
from turtlebot3_race import course_2017, course_2020  # noqa: E402

URDF = PACKAGE.parent / "turtlebot3_description" / "urdf"
STARTS = {  # world: robot, x, y
    "turtlebot3_house": ("waffle", -3.0, 1.0),
    "turtlebot3_stage_1": ("burger", 0.0, 0.0),
    "turtlebot3_stage_2": ("burger", 0.0, 0.0),
    "turtlebot3_stage_3": ("burger", 0.0, 0.0),
    "turtlebot3_stage_4": ("burger", -0.7, 0.0),
    "turtlebot3_autorace": ("burger_for_autorace", 0.245, -1.787),
    "turtlebot3_autorace_2020": ("burger_for_autorace_2020", 0.8, -1.747),
}
SPAWNED = ["traffic_light_red", "traffic_light_yellow", "traffic_light_green", "traffic_bar_up",
           "traffic_bar_down", "traffic_left", "traffic_right", "turtlebot3_burger"]
PUT_IN = {"turtlebot3_square/goal_box": "goal_box", "turtlebot3_goalbox": "turtlebot3_goalbox",
          "turtlebot3_obstacle": "turtlebot3_obstacle", "turtlebot3_autorace/ground": "ground",
          "turtlebot3_autorace/tunnel_obstacles": "tunnel_obstacles"}  # folder: model
LOADED_WITHIN = 2.0  # s of a processor


@pytest.fixture(scope="module")
def resources():
    return open_resources()


@pytest.fixture
def open_world(resources):
    opened = []

    def load(name):
        opened.append(World(load_world(PACKAGE / f"worlds/{name}.world", resources), seed=1))
        return opened[-1]

    yield load
    for world in opened:
        world.close()


def test_each_shipped_file_is_one_that_is_made():
    shipped = {str(path.relative_to(ROOT))
               for folder in ("models", "worlds") for path in (PACKAGE / folder).rglob("*")
               if path.is_file() and path.parent.name != "turtlebot3_world"}
    assert shipped == turtlebot3_worlds.files().keys()


@pytest.mark.parametrize("folder", PUT_IN)
def test_what_scripts_spawn_into_the_arenas(folder, resources):
    """By upstream's path, as the learning robots' scripts read it."""
    text = (PACKAGE / "models" / folder / "model.sdf").read_text(encoding="utf-8")
    model = load_model(text, resources)
    assert model.name == PUT_IN[folder]
    assert bool(model.links[0].collisions) is ("goal" not in folder)  # one drives over a goal


@pytest.mark.parametrize("name", STARTS)
def test_a_robot_stands_at_the_start(name, open_world, resources, caplog):
    robot, x, y = STARTS[name]
    began = time.process_time()
    world = open_world(name)
    assert time.process_time() - began < LOADED_WITHIN
    text = expand(URDF / f"turtlebot3_{robot}.urdf.xacro")
    model = world.spawn(load_model(text, resources), Pose((x, y, 0.0)), "robot")
    before = {each.name: each.pose for each in world.models.values()}
    world.step(1000)
    for each in world.models.values():
        if each is not model:
            assert math.dist(each.pose.position, before[each.name].position) < 0.01, each.name
    assert math.dist(model.pose.position, (x, y, 0.0)) < 0.01
    assert [record.message for record in caplog.records if record.levelname != "INFO"] == []


def test_the_states_poses_count(open_world):
    world = open_world("turtlebot3_autorace_2020")
    assert world.model("unit_box").pose.position == pytest.approx((-1.72, 0.56, 0.12))
    heights = {name: world.model(name).pose.position for name in
               ("unit_sphere", "unit_sphere_1", "unit_sphere_2")}
    assert [at[2] for at in heights.values()] == pytest.approx([0.11, 0.21, 0.31])
    assert all(at[:2] == pytest.approx((1.39, -1.57)) for at in heights.values())
    assert world.model("barrier_2").pose.position == pytest.approx((1.74, 1.0, 0.15))
    west = world.link("tunnel_wall::west").pose.position
    assert west == pytest.approx((-2.0, -1.0, 0.25))


@pytest.mark.parametrize("name", SPAWNED)
def test_what_a_mission_spawns(name, open_world, resources):
    world = open_world("turtlebot3_autorace_2020")
    text = (PACKAGE / f"models/turtlebot3_autorace_2020/{name}/model.sdf").read_text()
    if name == "turtlebot3_burger":
        assert "<static>0" in text
        text = text.replace("<static>0", "<static>1")
    model = world.spawn(load_model(text, resources), Pose((0.0, 0.0, 0.0)), f"spawned_{name}")
    world.step(10)
    assert model.description.static


@pytest.mark.parametrize("course, yaw, lane, middle", [
    (course_2017, -1.54, 0.296, (0.245, -1.787)), (course_2020, -3.14, 0.25, (0.6, -1.747)),
])
def test_yellow_is_left_and_white_right_of_the_start(course, yaw, lane, middle):
    canvas = course()
    for colour, side in ((YELLOW, 1), (WHITE, -1)):
        x, y = middle[0], middle[1] + side * lane / 2
        assert tuple(pixel(canvas.pixels, x, y, yaw)) == colour
    assert max(pixel(canvas.pixels, *middle, yaw)) <= 10
    if course is course_2020:
        assert tuple(pixel(canvas.pixels, 0.95, -1.747, yaw)) == RED


def pixel(pixels, x, y, yaw):
    """The colour at a place of the world, on a plane of 4 m that is turned by yaw."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    column, row = (cos * x + sin * y + 2.0) / 4.0, (2.0 - (cos * y - sin * x)) / 4.0
    return pixels[int(row * len(pixels)), int(column * len(pixels))]


def test_painted_lines_have_their_width_and_areas_their_edges():
    canvas = Canvas(200, 2.0, (0, 0, 0))
    canvas.stroke([(-0.5, 0.0), (0.5, 0.0)], 0.2, WHITE)
    assert (canvas.pixels[:, 100, 0] == 255).sum() == 20
    canvas.fill([(-0.9, -0.9), (-0.5, -0.9), (-0.5, -0.5), (-0.9, -0.5)], RED)
    assert (canvas.pixels == np.array(RED)).all(axis=2).sum() == 40 * 40
    assert canvas.png()[:4] == b"\x89PNG"


def test_the_house_has_room_where_robots_start():
    text = (PACKAGE / "models/turtlebot3_house/model.sdf").read_text(encoding="utf-8")
    boxes = re.findall(r"<collision name=\"\w+\"><pose>(\S+) (\S+) .*?<size>(\S+) (\S+) ", text)
    for x, y in ((-3.0, 1.0), (-7.0, -1.0), (7.0, -1.0), (0.5, 3.0)):
        for middle_x, middle_y, long, wide in (map(float, each) for each in boxes):
            aside = max(abs(x - middle_x) - long / 2, abs(y - middle_y) - wide / 2)
            assert aside > 0.4
