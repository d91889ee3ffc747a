"""Every world, model and launch file here against upstream's published numbers."""

import math
from pathlib import Path
from xml.etree import ElementTree

import pytest

PACKAGE = Path(__file__).resolve().parent.parent
SQUARE, PLAZA = "turtlebot3_square", "turtlebot3_plaza"
WORLDS = {  # name: models included
    "empty": ["ground_plane", "sun"],
    "turtlebot3_world": ["ground_plane", "sun", "turtlebot3_world"],
    "turtlebot3_house": ["ground_plane", "sun", "turtlebot3_house"],
    "turtlebot3_stage_1": ["ground_plane", "sun", SQUARE],
    "turtlebot3_stage_2": ["ground_plane", "sun", SQUARE],
    "turtlebot3_stage_3": ["ground_plane", "sun", SQUARE],
    "turtlebot3_stage_4": ["ground_plane", "sun", PLAZA],
    "turtlebot3_autorace": [f"turtlebot3_autorace/{name}" for name in (
        "autorace_course", "traffic_parking", "traffic_tunnel", "traffic_stop")],
    "turtlebot3_autorace_2020": [f"turtlebot3_autorace_2020/{name}" for name in (
        "course", "traffic_parking", "traffic_tunnel", "traffic_stop", "traffic_pl_left",
        "traffic_construction", "traffic_intersection", "traffic_noentry", "checker")],
}
LAUNCHES = {  # name: world, x_pos, y_pos
    "turtlebot3_empty_world": ("empty", "0.0", "0.0"),
    "turtlebot3_world": ("turtlebot3_world", "-2.0", "-0.5"),
}
EMPTY_WORLD = {"paused": "false", "use_sim_time": "true", "gui": "true", "headless": "false",
               "debug": "false", "viewer": "$(arg viewer)"}
CAMERA_SIZE = {"camera_width": "", "camera_height": ""}  # ours: as the robot's own
LIMBS = {"head": (3.5, 0.0, 0.8), "left_hand": (1.8, 2.7, 0.55), "right_hand": (1.8, -2.7, 0.55),
         "left_foot": (-1.8, 2.7, 0.55), "right_foot": (-1.8, -2.7, 0.55)}  # x, y, size in m


def parse(*place):
    return ElementTree.parse(PACKAGE.joinpath(*place)).getroot()


def stem_names(folder, pattern):
    return {path.stem for path in (PACKAGE / folder).glob(pattern)}


def defaults(launch):
    return {arg.get("name"): arg.get("default") for arg in launch.findall("arg")}


def test_nothing_is_left_out_of_these_tests():
    assert stem_names("worlds", "*") == set(WORLDS)


@pytest.mark.parametrize("name", WORLDS)
def test_world(name):
    world = parse("worlds", f"{name}.world").find("world")
    models = [uri.text.removeprefix("model://") for uri in world.findall("include/uri")]
    assert models == WORLDS[name]
    assert float(world.findtext("physics/real_time_update_rate")) == 1000
    assert float(world.findtext("physics/max_step_size")) == 0.001
    solver, constraints = world.find("physics/ode/solver"), world.find("physics/ode/constraints")
    assert (solver.findtext("type"), solver.findtext("iters")) == ("quick", "150")
    assert float(constraints.findtext("contact_max_correcting_vel")) == 2000


@pytest.mark.parametrize("name", LAUNCHES)
def test_world_launch(name):
    world, x, y = LAUNCHES[name]
    launch = parse("launch", f"{name}.launch")
    assert defaults(launch) == {"model": "$(optenv TURTLEBOT3_MODEL waffle)", "x_pos": x,
                                "y_pos": y, "z_pos": "0.0", "viewer": "false", **CAMERA_SIZE}
    for name in CAMERA_SIZE:
        assert f"{name}:=$(arg {name})" in launch.find("param").get("command")
    given = {arg.get("name"): arg.get("value") for arg in launch.findall("include/arg")}
    assert given.pop("world_name") == f"$(find turtlebot3_gazebo)/worlds/{world}.world"
    assert given == EMPTY_WORLD
    spawner = launch.find("node[@name='spawn_urdf'][@pkg='gazebo_ros'][@type='spawn_model']")
    assert "-urdf -model turtlebot3_$(arg model) " in spawner.get("args")


def test_simulation_launch():
    launch = parse("launch/turtlebot3_simulation.launch")
    assert defaults(launch) == {"cmd_vel": "/cmd_vel", "name": "turtlebot3"}
    node = launch.find("node[@name='$(arg name)_drive']")
    assert (node.get("type"), node.get("required")) == ("turtlebot3_drive", "true")


def test_package_exports_its_worlds_and_models():
    exports = [each.attrib for each in parse("package.xml").findall("export/gazebo_ros")]
    assert exports == [{"gazebo_media_path": "${prefix}"},
                       {"gazebo_model_path": "${prefix}/models"}]


@pytest.fixture(scope="module")
def symbol():
    model = parse("models/turtlebot3_world/model.sdf").find("model")
    assert (model.get("name"), model.findtext("static")) == ("ros_symbol", "1")
    return model.find("link")


def poses(link, prefix):
    return [tuple(map(float, each.findtext("pose").split())) for each in link.findall("collision")
            if each.get("name").startswith(prefix)]


def test_nine_columns(symbol):
    columns = [each for each in symbol.findall("collision") if each.find("geometry/cylinder")]
    sizes = {(each.findtext(".//radius"), each.findtext(".//length")) for each in columns}
    assert sizes == {("0.15", "0.5")}
    places = {tuple(map(float, each.findtext("pose").split()))[:3] for each in columns}
    assert places == {(x, y, 0.25) for x in (-1.1, 0, 1.1) for y in (-1.1, 0, 1.1)}


@pytest.mark.parametrize("limb", LIMBS)
def test_a_limb_is_a_hexagon_of_three_boxes(symbol, limb):
    x, y, size = LIMBS[limb]
    boxes = poses(symbol, limb)
    assert {pose[:3] for pose in boxes} == {(x, y, 0.25)}
    assert [round(math.degrees(pose[5])) for pose in boxes] == [30, 90, 150]
    shapes = {each.findtext(".//size") for each in symbol.findall("collision")
              if each.get("name").startswith(limb)}
    assert shapes == {f"{size * math.sqrt(3):.4f} {size:g} 0.5"}


def test_the_wall_closes(symbol):
    walls = poses(symbol, "body")
    assert len(walls) == 6
    assert all(math.hypot(x, y) == pytest.approx(2.6, abs=1e-4) for x, y, *_ in walls)
    length = 2 * (2.6 + 0.15 / 2) * math.tan(math.radians(30))  # of the outer side
    sizes = {each.findtext(".//size") for each in symbol.findall("collision")
             if each.get("name").startswith("body")}
    assert sizes == {f"0.15 {length:.4f} 0.5"}


def shape_text(shape):
    return [(each.tag, each.text) for each in shape.iter()]


def test_what_is_seen_is_what_is_touched(symbol):
    def shapes(tag):
        return {each.get("name"): (each.findtext("pose"), shape_text(each.find("geometry")[0]))
                for each in symbol.findall(tag)}

    assert shapes("visual") == shapes("collision")
