"""Meshes far away are drawn in fewer triangles, and nobody sees it."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
import trimesh

from bullet_sim.description import LightDescription, Material, Mesh, SceneDescription, Visual
from bullet_sim.meshes.smoothing import smooth_shaded
from bullet_sim.pose import Pose
from bullet_sim.rendering import egl
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.scene import LinkShape, Scene

TRIANGLES = 20480
FOV = 1.0  # rad
DARK = SceneDescription(ambient=(0.2, 0.2, 0.2, 1.0), background=(0.0, 0.0, 0.0, 1.0))


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A ball at the origin."""
    file = tmp_path_factory.mktemp("meshes") / "ball.stl"
    trimesh.creation.icosphere(5, 0.5).export(file)
    made = Scene(DARK)
    made.add_light(LightDescription("sun", type="directional", direction=(0.5, 0.3, -0.8)))
    made.add_link(("ball", "link"), [Visual("ball", Mesh(str(file)), material=Material(
        diffuse=(0.9, 0.6, 0.3, 1.0)))], Pose())
    return made


def view_from(distance, width=320):
    return CameraView(width, width * 3 // 4, FOV, 0.05, 50.0, Pose((-distance, 0.0, 0.0)))


@pytest.fixture
def drawn(renderer, scene, monkeypatch):
    """Draws a view: the frame, and how many triangles went into it."""
    counts = []
    render = egl._render

    def counted(target, node, pieces, clip_node):
        counts.extend(array.vertices // 3 for _, (_, array), _ in pieces)
        render(target, node, pieces, clip_node)

    monkeypatch.setattr(egl, "_render", counted)

    def draw(view):
        counts.clear()
        return renderer.draw(scene, view, depth=True), sum(counts)

    return draw


@pytest.mark.parametrize("distance, most", [(0.55, TRIANGLES), (3.5, 4200), (12.0, 800)])
def test_the_picture_is_the_same(drawn, monkeypatch, distance, most):
    view = view_from(distance)
    frame, triangles = drawn(view)
    monkeypatch.setattr(egl, "_UNSEEN", 0.0)
    whole, all_of_them = drawn(view)
    assert all_of_them == TRIANGLES and triangles <= most
    # The outline differs by less than a pixel, in few of its pixels.
    inside, inside_of_whole = np.isfinite(frame.depth), np.isfinite(whole.depth)
    wider = cv2.dilate(inside_of_whole.astype(np.uint8), np.ones((3, 3)))
    smaller = cv2.erode(inside_of_whole.astype(np.uint8), np.ones((3, 3)))
    assert not (inside & (wider == 0)).any() and not (~inside & (smaller == 1)).any()
    # Within it depths agree within half a pixel's width there, more where the ball turns away.
    deep = cv2.erode(inside_of_whole.astype(np.uint8), np.ones((9, 9))) == 1
    width_of_pixel = whole.depth[deep] / view.focal_length_px
    assert (abs(frame.depth[deep] - whole.depth[deep]) < width_of_pixel).mean() > 0.99
    changes = abs(frame.rgb[deep].astype(int) - whole.rgb[deep]).max(axis=1)
    assert np.mean(changes) < 1.5 and np.percentile(changes, 99) <= 10


def test_who_comes_near_sees_all_of_it(drawn):
    triangles = [drawn(view_from(distance))[1] for distance in (16, 8, 4, 2, 0.55)]
    assert triangles == sorted(triangles) and len(set(triangles)) >= 4
    assert drawn(view_from(4.0, 1280))[1] > drawn(view_from(4.0, 160))[1]


def test_a_mesh_with_a_picture_on_it_is_drawn_whole(renderer, tmp_path):
    made = trimesh.creation.icosphere(4, 0.5)
    part = smooth_shaded(made.vertices, made.faces, made.vertices[:, :2])
    cv2.imwrite(str(tmp_path / "wood.png"), np.full((8, 8, 3), 90, np.uint8))
    painted = replace(part, material=Material(texture=str(tmp_path / "wood.png")))
    plain = replace(part, material=Material())
    with renderer._context:
        surfaces = renderer._store.of(LinkShape((painted, plain, plain), np.zeros(3), 0.5))
        with_picture, one, other = (surface.triangles for surface in surfaces)
        levels = renderer._store.coarser(one)
        assert renderer._store.coarser(with_picture) == []
    assert one is other and len(levels) > 2  # uploaded once
    assert all(np.isinf(coarser.finest) for _, coarser in levels)


def test_a_mesh_that_is_always_near_is_never_simplified(renderer, scene, monkeypatch):
    asked = []
    monkeypatch.setattr("bullet_sim.rendering.gpu_surfaces.levels",
                        lambda part: asked.append(part) or [])
    other = EglRenderer()
    other.draw(scene, view_from(0.55))
    assert not asked
    other.draw(scene, view_from(8.0))
    other.draw(scene, view_from(9.0))
    other.close()
    assert len(asked) == 1


def test_lights_that_come_and_go_leave_no_shaders(scene):
    renderer = EglRenderer()
    counts = []
    for turn in range(12):
        for number in range(turn % 4):
            kind = ("point", "spot", "directional")[(turn + number) % 3]
            scene.add_light(LightDescription(f"lamp_{number}", type=kind))
        renderer.draw(scene, view_from(2.0))
        counts.append(len(renderer._store._programs))
        for number in range(turn % 4):
            scene.remove_light(f"lamp_{number}")
    renderer.close()
    assert max(counts) <= 4


def test_a_camera_inside_a_mesh_sees_no_less(drawn):
    view = CameraView(64, 48, FOV, 0.01, 50.0, Pose((0.0, 0.0, 0.0)))
    frame, triangles = drawn(view)
    assert triangles == TRIANGLES
    assert np.isinf(frame.depth).all()  # from inside it is not seen
