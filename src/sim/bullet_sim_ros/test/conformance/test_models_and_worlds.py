"""Models and worlds that come with the simulator: found by name, spawned from the database, and the
worlds of gazebo_plugins with what their plugins publish."""

import re
from pathlib import Path

import numpy as np
import pybullet
import pytest
import rospkg
from std_msgs.msg import String

from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim_ros.interface import read_interface, rows_by_name

TEST_WORLDS = Path(rospkg.RosPack().get_path("gazebo_plugins")) / "test/test_worlds"
DATABASE = ('<sdf version="1.4"><world name="default"><include><uri>model://{}</uri></include>'
            "</world></sdf>")  # what spawn_model -database sends
PREFIX = "models: "
TABLE = rows_by_name(read_interface())
ALREADY_THERE = {"ground_plane", "sun"}
UNPACED = '<physics type="ode"><real_time_update_rate>0</real_time_update_rate></physics>'
# Upstream's have no collision shape; the saucepan's handle has none.
DRAWN_ALONE = {"checkerboard_plane", "saucepan", *(f"number{digit}" for digit in range(1, 10))}


def text_of(path: Path) -> str:
    """A world that runs as fast as it goes."""
    return re.sub('<world name=".*">', rf"\g<0>{UNPACED}", path.read_text(encoding="utf-8"))


def spawn_all(bench, theme: str) -> None:
    """Those that the table lists: each collides where it is drawn, and ends on the ground."""
    for name in TABLE[f"{PREFIX}{theme}"].tags.keys() - ALREADY_THERE:
        answer = bench.call("/gazebo/spawn_sdf_model", model_name=name,
                            model_xml=DATABASE.format(name))
        assert answer.success, answer.status_message
        model = bench.world.models[name]
        if name not in DRAWN_ALONE:
            assert colliding_box(bench, model) == pytest.approx(drawn_box(bench, model), abs=0.035)
            if not model.static:
                before = colliding_box(bench, model)[2]
                bench.run(0.4)  # what is spawned deep in the ground rises at 0.2 m/s
                assert min(0.0, before + 0.06) - 0.01 < colliding_box(bench, model)[2] < 0.01, name
        else:
            assert np.ptp(drawn_box(bench, model).reshape(2, 3), axis=0).max() > 0.1
        bench.delete(name)


def drawn_box(bench, model) -> np.ndarray:
    """Least and greatest x, y, z of what is drawn, in the world; (6,) m."""
    nodes = [node for (owner, _), node in bench.world.update_scene().nodes.items()
             if owner == model.name]
    corners = [np.asarray([node.pose.transform(corner) for corner in part.vertices])
               for node in nodes for part in node.shape.parts]
    return np.concatenate([np.vstack(corners).min(axis=0), np.vstack(corners).max(axis=0)])


def colliding_box(bench, model) -> np.ndarray:
    """The same of its collision shapes, as the engine has them."""
    boxes = [bench.world._client.read(pybullet.getAABB, body.number, index)
             for body in model.bodies for index, link in enumerate(body.tree.links, start=-1)
             if link.collisions]
    least, greatest = zip(*boxes, strict=True)
    return np.concatenate([np.min(least, axis=0), np.max(greatest, axis=0)])


@pytest.mark.parametrize("theme", [name.removeprefix(PREFIX) for name in TABLE
                                   if name.startswith(PREFIX)])
def test_models_are_spawned_from_the_database(bench, theme):
    # conforms: models: barriers/each, models: buildings/each, models: household/each
    # conforms: models: markings/each, models: shapes/each, models: street/each
    # conforms: models: robots/each
    spawn_all(bench, theme)


def test_ground_and_sun_come_with_the_world(bench):
    # conforms: models: robots/ground_plane, models: robots/sun
    assert "ground_plane" in bench.world.models and "sun" in bench.world.scene.lights


def test_the_table_has_every_model():
    listed = {name for row in TABLE.values() if row.name.startswith(PREFIX) for name in row.tags}
    assert listed == {path.name for path in (DATA_FOLDER / "models").iterdir()}


def test_pioneers_wheels_carry_it(bench):
    # conforms: models: robots/pioneer2dx
    bench.call("/gazebo/spawn_sdf_model", model_name="p", model_xml=DATABASE.format("pioneer2dx"))
    model = bench.world.models["p"]
    for side in ("left", "right"):
        model.joint(f"{side}_wheel_hinge").drive_velocity(5.0, 5.0)  # rad/s, N m
    bench.run(1.0)
    assert model.pose.position[0] == pytest.approx(0.11 * 5.0, abs=0.08)


@pytest.mark.parametrize(("world", "topics"), [
    ("gazebo_ros_range", {"/sonar", "/sonar2"}),
    ("gazebo_ros_laser", {"/test_laser"}),
    ("gazebo_ros_gpu_laser", {"/test_gpu_laser"}),
    ("gazebo_ros_block_laser", {"/test_block_laser"}),
    ("gazebo_ros_block_laser_clipping", {"/test_block_laser"}),
    ("gazebo_ros_camera", {"/image_raw", "/camera_info"}),
    ("gazebo_ros_depth_camera", {"/depth_cam/image_raw", "/depth_cam/points"}),
    ("bumper_test", {"/box_bumper", "/box1_bumper"}),
    ("test_lasers", {"/test_laser", "/test_gpu_laser", "/test_block_laser"}),
    ("gazebo_ros_trimesh_collision", set()),
    ("trisphere_cycle_wheel_slip", set()),
    ("elevator", set()),
])
def test_a_world_of_gazebo_plugins_loads_and_publishes(make_bench, world, topics):
    # conforms: gazebo_plugins test_worlds/bumper_test, gazebo_plugins test_worlds/elevator
    # conforms: gazebo_plugins test_worlds/gazebo_ros_block_laser
    # conforms: gazebo_plugins test_worlds/gazebo_ros_block_laser_clipping
    # conforms: gazebo_plugins test_worlds/gazebo_ros_camera
    # conforms: gazebo_plugins test_worlds/gazebo_ros_depth_camera
    # conforms: gazebo_plugins test_worlds/gazebo_ros_gpu_laser
    # conforms: gazebo_plugins test_worlds/gazebo_ros_laser
    # conforms: gazebo_plugins test_worlds/gazebo_ros_range
    # conforms: gazebo_plugins test_worlds/gazebo_ros_trimesh_collision
    # conforms: gazebo_plugins test_worlds/test_lasers
    # conforms: gazebo_plugins test_worlds/trisphere_cycle_wheel_slip
    bench = make_bench(text_of(TEST_WORLDS / f"{world}.world"))
    heard = {topic: bench.listen(topic) for topic in topics}
    assert topics <= set(bench.advertised())
    bench.run(1.2 if world == "gazebo_ros_camera" else 0.25)
    assert all(heard.values()), {topic: len(messages) for topic, messages in heard.items()}


def test_the_first_sonar_sees_the_second(make_bench):
    # conforms: gazebo_plugins test_worlds/gazebo_ros_range
    bench = make_bench(text_of(TEST_WORLDS / "gazebo_ros_range.world"))
    first, second = bench.listen("/sonar"), bench.listen("/sonar2")
    bench.run(0.5)
    assert first[-1].range == pytest.approx(0.225, abs=0.01)
    assert second[-1].range == pytest.approx(0.75, abs=0.03)


def test_the_lift_goes_up_when_called(make_bench):
    # conforms: worlds/elevator_ros.world
    bench = make_bench(text_of(DATA_FOLDER / "worlds/elevator_ros.world"))
    lift = bench.world.models["elevator"]
    bench.run(0.2)
    bench.send("/elevator", String("1"))
    bench.run(8.0)
    assert lift.link("link").pose.position[2] == pytest.approx(3.15, abs=0.1)


@pytest.mark.parametrize(("world", "models"), [
    ("blank.world", set()),
    ("empty.world", {"ground_plane"}),
    ("empty_sky.world", {"ground_plane"}),
    ("shapes.world", {"ground_plane", "box", "sphere", "cylinder"}),
    ("willowgarage.world", {"ground_plane", "willowgarage"}),
    ("simple_arm.world", {"ground_plane", "simple_arm"}),
    ("pioneer2dx.world", {"ground_plane", "pioneer2dx"}),
    ("mud.world", {"ground_plane", "pendulum_thick_mud", "pendulum_thin_mud", "pendulum_no_mud",
                   "mud_pit_thin", "mud_pit_thick", "mud_patch"}),
    ("rubble.world", {"ground_plane", "cylinder_0", "box_1"}),
    ("stacks.world", {"ground_plane", "box_1", "sphere_1", "sphere_1a", "cylinder_1"}),
    ("camera.world", {"ground_plane", "camera", "camera 2"}),
    ("depth_camera.world", {"ground_plane", "depth_camera", "box"}),
    ("empty_bullet.world", {"ground_plane", "drill"}),
    ("robocup14_spl_field.world", {"ground_plane", "RoboCup 14 SPL Field", "left goal",
                                   "right goal", "RoboCup SPL Ball"}),
    ("heightmap.world", {"heightmap", "box1", "box2", "box3", "box4"}),
    ("cafe.world", {"ground_plane", "cafe", "table1", "table5", "actor1", "actor2"}),
])
def test_a_world_of_gazebos_media_has_its_models(make_bench, world, models):
    # conforms: worlds/blank.world, worlds/empty.world, worlds/empty_sky.world
    # conforms: worlds/shapes.world, worlds/willowgarage.world, worlds/simple_arm.world
    # conforms: worlds/pioneer2dx.world, worlds/mud.world, worlds/rubble.world
    # conforms: worlds/stacks.world, worlds/cafe.world, worlds/heightmap.world
    # conforms: worlds/camera.world, worlds/depth_camera.world, worlds/empty_bullet.world
    # conforms: worlds/robocup14_spl_field.world
    bench = make_bench(text_of(DATA_FOLDER / "worlds" / world))
    names = bench.call("/gazebo/get_world_properties").model_names
    assert models <= set(names) and (len(names) == len(models) or world in BIG)
    bench.run(0.05)


BIG = ("rubble.world", "stacks.world", "cafe.world")  # with more models than are named here
