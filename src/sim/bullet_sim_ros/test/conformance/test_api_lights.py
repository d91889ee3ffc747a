"""Lights that services of /gazebo bring, change and take, seen by a camera."""

import numpy as np
import pytest
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA

DARK = """<sdf version="1.6"><world name="default">
  <physics type="ode"><real_time_update_rate>0</real_time_update_rate></physics>
  <scene><ambient>0 0 0 1</ambient><background>0 0 0 1</background></scene>
  <light name="lamp" type="point"><pose>0 0 2 0 0 0</pose><diffuse>1 1 1 1</diffuse>
    <attenuation><range>20</range><constant>0.5</constant><linear>0.25</linear>
      <quadratic>0.125</quadratic></attenuation></light>
  <model name="m"><static>true</static><link name="wall"><visual name="v"><geometry><box>
    <size>4 4 0.1</size></box></geometry><material><ambient>1 1 1 1</ambient>
    <diffuse>1 1 1 1</diffuse><specular>1 1 1 1</specular>
    <shininess>1</shininess></material></visual></link>
  <link name="eye"><pose>0 0 3 0 1.5708 0</pose><sensor name="s" type="camera">
    <update_rate>10</update_rate><camera><image><width>16</width><height>16</height></image>
    </camera><plugin name="p" filename="libgazebo_ros_camera.so"><cameraName>eye</cameraName>
    </plugin></sensor></link></model></world></sdf>"""
SPOT = "<sdf version='1.6'><light type='{}' name='x'><pose>0 0 2 0 0 0</pose>{}</light></sdf>"
DOWN = Vector3(0, 0, -1)


@pytest.fixture
def dark(make_bench):
    return make_bench(DARK)


def colour(bench):
    """Mean colour of the next picture, 0..255 each."""
    images = bench.listen("/eye/image_raw")
    bench.run(0.15)
    picture = np.frombuffer(bytes(images[-1].data), np.uint8)
    return picture.reshape(-1, 3).mean(axis=0)


def set_light(bench, **fields):
    values = dict(light_name="lamp", diffuse=ColorRGBA(1, 1, 1, 1), attenuation_constant=1.0,
                  direction=DOWN, pose=Pose(Point(0, 0, 2), Quaternion(0, 0, 0, 0)))
    return bench.call("/gazebo/set_light_properties", **{**values, **fields})


def test_what_a_light_is_like(dark):
    # conforms: /gazebo/get_light_properties, /gazebo/get_light_properties/light_name
    # conforms: /gazebo/get_light_properties/diffuse, /gazebo/get_light_properties/success
    # conforms: /gazebo/get_light_properties/attenuation_constant
    # conforms: /gazebo/get_light_properties/attenuation_linear
    # conforms: /gazebo/get_light_properties/attenuation_quadratic
    # conforms: /gazebo/get_light_properties/status_message
    answer = dark.call("/gazebo/get_light_properties", light_name="lamp")
    assert answer.diffuse == ColorRGBA(1, 1, 1, 1)
    assert (answer.attenuation_constant, answer.attenuation_linear,
            answer.attenuation_quadratic) == (0.5, 0.25, 0.125)
    assert (answer.success, answer.status_message) == (True, "")
    answer = dark.call("/gazebo/get_light_properties", light_name="lump")
    assert (answer.success, answer.status_message) == (
        False, "getLightProperties: Requested light lump not found!")


def test_colours_of_a_light(dark):
    # conforms: /gazebo/set_light_properties, /gazebo/set_light_properties/light_name
    # conforms: /gazebo/set_light_properties/diffuse, /gazebo/set_light_properties/specular
    # conforms: /gazebo/set_light_properties/success
    # conforms: /gazebo/set_light_properties/status_message
    answer = set_light(dark, diffuse=ColorRGBA(1, 0.5, 0, 1))
    assert (answer.success, answer.status_message) == (True, "")
    red, green, blue = colour(dark)
    assert red > 60 and green == pytest.approx(red / 2, abs=3) and blue == 0
    told = dark.call("/gazebo/get_light_properties", light_name="lamp")
    assert (told.diffuse, told.attenuation_linear) == (ColorRGBA(1, 0.5, 0, 1), 0.0)
    set_light(dark, diffuse=ColorRGBA(0, 0, 0, 1))
    assert colour(dark).max() == 0
    set_light(dark, diffuse=ColorRGBA(0, 0, 0, 1), specular=ColorRGBA(0, 1, 0, 1))
    assert colour(dark)[1] > 0  # the wall shines
    answer = set_light(dark, light_name="lump")
    assert (answer.success, answer.status_message) == (
        False, "setLightProperties: Requested light lump not found!")


@pytest.mark.parametrize("term", ["constant", "linear", "quadratic"])
def test_how_a_light_fades(dark, term):
    # conforms: /gazebo/set_light_properties/attenuation_constant
    # conforms: /gazebo/set_light_properties/attenuation_linear
    # conforms: /gazebo/set_light_properties/attenuation_quadratic
    weak = {"attenuation_constant": 0.0, f"attenuation_{term}": 4.0}
    strong = {"attenuation_constant": 0.0, f"attenuation_{term}": 2.0}
    set_light(dark, **weak)
    before = colour(dark).mean()
    set_light(dark, **strong)
    assert before > 0 and colour(dark).mean() == pytest.approx(2 * before, rel=0.1)


def test_where_a_light_is_and_where_it_points(dark):
    # conforms: /gazebo/set_light_properties/pose, /gazebo/set_light_properties/direction
    set_light(dark, pose=Pose(Point(0, 0, 2.5), Quaternion(0, 0, 0, 0)))
    assert colour(dark).mean() > 10
    set_light(dark, pose=Pose(Point(0, 0, -2), Quaternion(0, 0, 0, 0)))  # behind the wall
    assert colour(dark).max() == 0
    spot = SPOT.format("spot", "<spot><inner_angle>0.5</inner_angle>"
                               "<outer_angle>0.6</outer_angle></spot>")
    assert dark.call("/gazebo/spawn_sdf_model", model_name="spot", model_xml=spot).success
    bright = colour(dark).mean()
    set_light(dark, light_name="spot", direction=Vector3(0, 0, 1))
    assert bright > 0 and colour(dark).max() == 0


def test_whether_a_light_casts_shadows(dark):
    # conforms: /gazebo/set_light_properties/cast_shadows
    roof = """<sdf version='1.6'><model name='roof'><static>true</static><link name='l'>
      <pose>0 0 0.5 0 0 0</pose><visual name='v'><geometry><box><size>1 0.4 0.1</size></box>
      </geometry></visual></link></model></sdf>"""
    assert dark.call("/gazebo/spawn_sdf_model", model_name="roof", model_xml=roof).success
    spot = SPOT.format("spot", "<spot><inner_angle>1.2</inner_angle>"
                               "<outer_angle>1.4</outer_angle></spot>")
    assert dark.call("/gazebo/spawn_sdf_model", model_name="spot", model_xml=spot).success
    set_light(dark, diffuse=ColorRGBA(0, 0, 0, 1))
    levels = []
    for cast in False, True:
        set_light(dark, light_name="spot", cast_shadows=cast, direction=Vector3(0, 1.5, -2),
                  pose=Pose(Point(0, -1.5, 2), Quaternion(0, 0, 0, 0)))
        levels.append(colour(dark).mean())
    assert 0 < levels[1] < 0.95 * levels[0]


def test_light_numbers_that_are_none_are_refused(dark):
    # conforms: /gazebo/set_light_properties/diffuse
    assert "finite" in set_light(dark, diffuse=ColorRGBA(float("nan"), 0, 0, 1)).status_message
    assert "below 0" in set_light(dark, attenuation_linear=-1.0).status_message


def test_a_light_is_taken_away(dark):
    # conforms: /gazebo/delete_light, /gazebo/delete_light/light_name
    # conforms: /gazebo/delete_light/success, /gazebo/delete_light/status_message
    assert colour(dark).mean() > 10
    answer = dark.call("/gazebo/delete_light", light_name="lamp")
    assert (answer.success, answer.status_message) == (
        True, "DeleteLight: lamp successfully deleted")
    assert colour(dark).max() == 0
    answer = dark.call("/gazebo/delete_light", light_name="lamp")
    assert (answer.success, answer.status_message) == (
        False, 'DeleteLight: Timeout reached while removing light "lamp"')


def test_a_light_is_spawned_under_the_wanted_name(dark):
    # conforms: /gazebo/spawn_sdf_model/light
    dark.call("/gazebo/delete_light", light_name="lamp")
    xml = SPOT.format("point", "<diffuse>0 1 0 1</diffuse>")
    high = Pose(Point(0, 0, 90), Quaternion(0, 0, 0, 1))  # not for lights
    answer = dark.call("/gazebo/spawn_sdf_model", model_name="green", model_xml=xml,
                       initial_pose=high)
    assert (answer.success, answer.status_message) == (
        True, "SpawnModel: Successfully spawned entity")
    red, green, _ = colour(dark)
    assert green > 60 and red < 10  # its highlight is white
    answer = dark.call("/gazebo/spawn_sdf_model", model_name="green", model_xml=xml)
    assert (answer.success, answer.status_message) == (
        False, "SpawnModel: Failure - entity already exists.")
