"""The `<camera>` of a sensor and the `<scene>` of a world, read from text."""

import pytest

from bullet_sim.description import CameraDescription, Fog, Lens, Noise, SceneDescription
from bullet_sim.formats.sdf.scene import read_scene
from bullet_sim.formats.sdf.sensor import read_camera, read_sensor
from bullet_sim.formats.xml_values import parse_xml
from bullet_sim.pose import Pose

ALL = """<camera name="c"><pose>1 2 3 0 0 0</pose><horizontal_fov>2</horizontal_fov>
  <image><width>64</width><height>48</height><format>L8</format></image>
  <clip><near>0.3</near><far>7</far></clip>
  <noise><type>gaussian</type><mean>0.1</mean><stddev>0.2</stddev></noise>
  <distortion><k1>1</k1><k2>2</k2><k3>3</k3><p1>4</p1><p2>5</p2><center>0.4 0.6</center>
  </distortion>
  <lens><type>custom</type><custom_function><c1>1.1</c1><c2>1.2</c2><c3>1.3</c3><f>1.4</f>
    <fun>sin</fun></custom_function><scale_to_hfov>false</scale_to_hfov>
    <cutoff_angle>1.5</cutoff_angle><env_texture_size>64</env_texture_size></lens></camera>"""


def camera(text: str) -> CameraDescription:
    return read_camera(parse_xml(f"<sensor>{text}</sensor>").find("camera"), "link 'l', sensor 's'")


def test_everything_that_a_camera_may_say():
    # conforms: sdf sensor/camera/lens/custom_function, sdf sensor/camera/lens/scale_to_hfov
    # conforms: sdf sensor/camera/distortion/center, sdf sensor/camera/lens/env_texture_size
    assert camera(ALL) == CameraDescription(
        2.0, 64, 48, "L8", 0.3, 7.0, Noise("gaussian", 0.1, 0.2), (1.0, 2.0, 4.0, 5.0, 3.0),
        (0.4, 0.6), Lens(1.1, 1.2, 1.3, "sin", 1.4, False, 1.5, 64), "c", Pose((1.0, 2.0, 3.0)))


def test_a_lens_of_its_own_that_says_nothing_more_has_sdf_s_defaults():
    lens = camera("<camera><lens><type>custom</type></lens></camera>").lens
    assert (lens.c1, lens.c2, lens.c3, lens.f, lens.function) == (1.0, 1.0, 0.0, 1.0, "tan")


@pytest.mark.parametrize("said, always", [("", False), ("<always_on>1</always_on>", True)])
def test_a_sensor_that_does_not_say_so_is_not_always_on(said, always):
    assert read_sensor(parse_xml(f"<sensor>{said}</sensor>"), "link 'l'").always_on == always


def test_a_camera_that_says_nothing():
    # conforms: sdf sensor/camera
    assert camera("<camera/>") == CameraDescription()


@pytest.mark.parametrize("kind, c1, c2, function", [
    ("gnomonical", 1, 1, "tan"), ("stereographic", 2, 2, "tan"), ("equidistant", 1, 1, "id"),
    ("equisolid_angle", 2, 2, "sin"), ("orthographic", 1, 1, "sin")])
def test_lenses_by_name(kind, c1, c2, function):
    # conforms: sdf sensor/camera/lens/type
    assert camera(f"<camera><lens><type>{kind}</type></lens></camera>").lens == Lens(
        c1, c2, function=function)


@pytest.mark.parametrize("lens, said", [
    ("<type>fish</type>", "<type>: no lens named 'fish'; there are: gnomonical, stereographic, "
     "equidistant, equisolid_angle, orthographic, custom; 'stereographic' is used instead"),
    ("<type>custom</type><custom_function><fun>cos</fun></custom_function>",
     "<fun>: no function named 'cos'; there are: sin, tan, id; 'tan' is used instead")])
def test_a_lens_that_nobody_knows(lens, said, caplog):
    assert camera(f'<camera name="c"><lens>{lens}</lens></camera>').lens.function == "tan"
    assert f"sensor 's' <camera name='c'> <lens> {said}" in caplog.text


def test_scene_and_fog(caplog):
    # conforms: sdf scene/sky, sdf scene/fog/type
    text = """<scene><ambient>.1 .2 .3 1</ambient><background>.4 .5 .6</background><sky/>
      <shadows>0</shadows><fog><color>1 0 0 1</color><type>linear</type><start>2</start>
      <end>3</end><density>4</density></fog></scene>"""
    assert read_scene(parse_xml(text), "world 'w'") == SceneDescription(
        (0.1, 0.2, 0.3, 1.0), (0.4, 0.5, 0.6, 1.0), False, True,
        Fog("linear", (1.0, 0.0, 0.0, 1.0), 2.0, 3.0, 4.0))
    assert read_scene(None, "world 'w'") == SceneDescription()
    thick = read_scene(parse_xml("<scene><fog><type>thick</type></fog></scene>"), "world 'w'")
    assert thick.fog.type == "none"
    assert "world 'w' <scene> <fog> <type>: no fog named 'thick'; there are: none" in caplog.text
