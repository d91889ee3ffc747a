"""Of two planes at the same height the smaller one is seen: courses lie on the ground plane."""

import numpy as np
import pytest

from bullet_sim.description import Material, Plane, SceneDescription, Visual
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.scene import Scene


def plane(size: float, colour) -> Visual:
    lit = Material(emissive=colour, diffuse=(0, 0, 0, 1), ambient=(0, 0, 0, 1))
    return Visual("plane", Plane((0.0, 0.0, 1.0), (size, size)), material=lit)


@pytest.mark.parametrize("height, pitch", [(4.5, 1.5707), (0.117, 0.05), (20.0, 1.2)])
@pytest.mark.parametrize("first", ["ground", "course"])
def test_the_smaller_of_two_planes_at_one_height_is_on_top(height, pitch, first):
    scene = Scene(SceneDescription())
    visuals = {"ground": plane(100.0, (0.0, 0.0, 1.0, 1.0)), "course": plane(4.0, (1, 0, 0, 1))}
    turned = Pose.from_xyz_rpy((0, 0, 0), (0, 0, -1.54))
    for name in sorted(visuals, key=lambda name: name != first):
        scene.add_link((name, "link"), (visuals[name],), turned if name == "course" else IDENTITY)
    view = CameraView(640, 480, 0.2, 0.03, 100.0,
                      Pose.from_xyz_rpy((-height / np.tan(pitch), 0, height), (0, pitch, 0)))
    renderer = EglRenderer()
    middle = renderer.draw(scene, view).rgb[238:242, 310:330]
    renderer.close()
    assert np.all(middle == (255, 0, 0))
