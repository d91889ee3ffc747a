"""Scenes as text and back, for who draws in another process."""

import json

import pytest

from bullet_sim.description import (
    Box,
    Cylinder,
    Heightmap,
    ImageExtrusion,
    LightDescription,
    Material,
    Mesh,
    Plane,
    PluginDescription,
    Polyline,
    SceneDescription,
    Sphere,
    Strip,
    TerrainLayer,
    Visual,
)
from bullet_sim.errors import FormatError
from bullet_sim.pose import Pose
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.scene_text import scene_from_text, scene_to_text

SHAPES = [
    Box((1.0, 2.0, 3.0)), Cylinder(0.1, 0.5), Sphere(0.3), Plane((0.0, 0.0, 1.0), (4.0, 5.0)),
    Heightmap(None, layers=(TerrainLayer(Material(), 2.0),)),
    Polyline((((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)),)),
    Strip(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), 0.2),
]
FILES = [Mesh("/nowhere/a.dae", (2.0, 2.0, 2.0), "wheel", True), ImageExtrusion("/nowhere/b.png")]
LOOK = Material(diffuse=(1.0, 0.5, 0.0, 0.7), texture="/nowhere/c.png", lighting=False)


def written(visual: Visual, pose: Pose = Pose()):
    """What comes back of a scene of one link."""
    scene = Scene(SceneDescription(background=(0.1, 0.2, 0.3, 1.0), sky=True))
    scene.add_light(LightDescription("sun", type="directional", pose=Pose((0.0, 0.0, 9.0))))
    scene.add_link(("robot", "base"), (visual,), pose)
    return scene, scene_from_text(scene_to_text(scene))


@pytest.mark.parametrize("shape", SHAPES + FILES, ids=lambda shape: type(shape).__name__)
def test_every_shape_comes_back_equal(shape):
    visual = Visual("seen", shape, Pose((0.0, 0.0, 0.1)), LOOK, transparency=0.5)
    _, content = written(visual)
    assert content.links == {("robot", "base"): (Pose(), (visual,))}
    assert hash(content.links["robot", "base"][1]) == hash((visual,))


def test_poses_lights_and_surroundings_come_back_equal():
    pose = Pose((1.0, 2.0, 3.0), (0.0, 0.0, 1.0, 0.0))
    scene, content = written(Visual("seen", SHAPES[0]), pose)
    assert content.links["robot", "base"][0] == pose
    assert content.description == scene.description
    assert content.lights == tuple(scene.lights.values())


def test_a_later_visual_is_in_the_text():
    scene, _ = written(Visual("seen", SHAPES[0]))
    scene.add_visual(("robot", "base"), Visual("more", SHAPES[2]))
    content = scene_from_text(scene_to_text(scene))
    assert [visual.name for visual in content.links["robot", "base"][1]] == ["seen", "more"]


def test_plugins_stay_where_they_are():
    plugin = PluginDescription("p", "libp.so", None)
    _, content = written(Visual("seen", SHAPES[0], plugins=(plugin,)))
    assert content.links["robot", "base"][1] == (Visual("seen", SHAPES[0]),)


@pytest.mark.parametrize("text", [
    "", "[]", "{}", '{"scene": 1}', json.dumps({"is": "Thing"}), json.dumps({"is": "Box"}),
])
def test_other_texts_are_no_scene(text):
    with pytest.raises(FormatError, match="this is not a scene"):
        scene_from_text(text)
