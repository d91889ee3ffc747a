"""What a world's `<scene>` does to pictures."""

import numpy as np
import pytest
from camera_models import WALL, eye

from bullet_sim.rendering.sky import HORIZON, ZENITH
from bullet_sim_ros.cameras.encodings import decode

FOG = "<fog><color>0 1 0 1</color><type>{}</type><start>1.5</start><end>3.5</end>" \
      "<density>0.5</density></fog>"
UP = "<sensor name=\"s\" type=\"camera\"><pose>0 0 0 0 -1.5707963 0</pose>"


def world(scene: str) -> str:
    return f"""<sdf version="1.6"><world name="default"><physics type="ode">
      <real_time_update_rate>0</real_time_update_rate></physics><scene>{scene}</scene>
      </world></sdf>"""


def look(bench, model=""):
    """The middle pixel of a camera at the origin."""
    bench.spawn(model or eye("libgazebo_ros_camera.so"))
    images = bench.listen("/eye/image_raw")
    bench.run(0.15)
    return decode(images[0])[12, 16].tolist()


def test_background_and_ambient_light(make_bench):
    # conforms: sdf scene/ambient, sdf scene/background, sdf scene
    bench = make_bench(world("<ambient>0.5 0.5 0.5 1</ambient><background>0 0 1 1</background>"))
    assert look(bench) == [0, 0, 255]
    bench.delete("eye")
    bench.spawn(WALL.replace("<emissive>1 0 0 1</emissive>", ""))
    assert look(bench) == [128, 0, 0]


@pytest.mark.parametrize("kind, share", [
    ("linear", 0.25), ("exp", 1 - np.exp(-1.0)), ("exp2", 1 - np.exp(-1.0)), ("none", 0.0),
    ("constant", 1 - np.exp(-1.0)), ("quadratic", 1 - np.exp(-1.0))])
def test_fog(make_bench, kind, share):
    # conforms: sdf scene/fog/type, sdf scene/fog/color, sdf scene/fog/start, sdf scene/fog/end
    # conforms: sdf scene/fog/density
    bench = make_bench(world(FOG.format(kind)))
    bench.spawn(WALL)
    np.testing.assert_allclose(look(bench), [255 * (1 - share), 255 * share, 0], atol=1.5)


def test_sky(make_bench):
    # conforms: sdf scene/sky
    bench = make_bench(world("<sky><clouds><speed>12</speed></clouds></sky>"))
    up = eye("libgazebo_ros_camera.so").replace('<sensor name="s" type="camera">', UP)
    np.testing.assert_allclose(look(bench, up), np.array(ZENITH) * 255, atol=2)
    bench.delete("eye")
    down = up.replace("-1.57", "1.57")
    np.testing.assert_allclose(look(bench, down), np.array(HORIZON) * 255, atol=2)


SUN = """<light name="sun" type="directional"><cast_shadows>{light}</cast_shadows>
  <diffuse>1 1 1 1</diffuse><direction>1 0 -1</direction></light>
  <model name="stage"><static>true</static><link name="l">
  <visual name="wall"><cast_shadows>0</cast_shadows><pose>2 0 0 0 0 0</pose><geometry><box>
    <size>0.1 4 4</size></box></geometry><material><ambient>0 0 0 1</ambient>
    <diffuse>1 0 0 1</diffuse></material></visual>
  <visual name="roof"><cast_shadows>{visual}</cast_shadows><pose>1 0 1 0 0 0</pose><geometry><box>
    <size>0.5 1 0.1</size></box></geometry></visual></link></model>"""


@pytest.mark.parametrize("scene, light, visual, dark", [
    ("<shadows>1</shadows>", 1, 1, True), ("", "true", "true", True),
    ("<shadows>0</shadows>", 1, 1, False), ("", 0, 1, False), ("", 1, "false", False)])
def test_shadows(make_bench, scene, light, visual, dark):
    # conforms: sdf scene/shadows, sdf light/cast_shadows, sdf visual/cast_shadows
    text = world(scene).replace("</world>", SUN.format(light=light, visual=visual) + "</world>")
    red = look(make_bench(text))[0]
    assert red == (0 if dark else pytest.approx(255 * np.sqrt(0.5), abs=1))
