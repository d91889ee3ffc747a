"""A camera that sees the same is not drawn again; whatever can change its picture draws it anew."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest

from bullet_sim.description import (
    Box,
    CameraDescription,
    JointDescription,
    Lens,
    LightDescription,
    LinkDescription,
    Material,
    ModelDescription,
    Noise,
    Plane,
    SensorDescription,
    Trajectory,
    Visual,
    WorldDescription,
)
from bullet_sim.pose import Pose
from bullet_sim.sensors.camera import Camera
from bullet_sim.world import World

SUN = LightDescription("sun", "directional", Pose((0.0, 0.0, 9.0)), direction=(0.3, 0.2, -1.0),
                       cast_shadows=True)
SMALL = CameraDescription(width=48, height=36)
NOISY = replace(SMALL, noise=Noise("gaussian", 0.0, 0.1))
BENT = replace(SMALL, distortion=(-0.3, 0.1, 0.0, 0.0, 0.0))
WIDE = replace(SMALL, horizontal_fov=3.0, lens=Lens(env_texture_size=32))
RED, FILM = Material(diffuse=(1.0, 0.0, 0.0, 1.0)), Material(texture="film")
GROUND = Visual("ground", Plane((0.0, 0.0, 1.0), (40.0, 40.0)), Pose((0.0, 0.0, -1.0)))


class Counting:
    """A renderer that counts what it draws."""

    def __init__(self, renderer):
        self.largest_px, self._renderer, self.count = renderer.largest_px, renderer, 0

    def draw(self, *arguments):
        self.count += 1
        return self._renderer.draw(*arguments)


def box(name, place, material=RED, **options):
    shown = Visual("v", Box((0.4, 0.4, 0.4)), material=material)
    return ModelDescription(name, Pose(place), links=(LinkDescription("l", visuals=(shown,)),),
                            **options)


GATE = ModelDescription("gate", Pose((2.0, 0.6, 0.0)), links=(
    LinkDescription("post"), LinkDescription("leaf", visuals=(
        Visual("v", Box((0.1, 0.6, 0.4)), Pose((0.0, 0.3, 0.0)), material=RED),))),
    joints=(JointDescription("foot", "fixed", "world", "post"),
            JointDescription("hinge", "revolute", "post", "leaf", axis=(0.0, 0.0, 1.0))))


@pytest.fixture
def scene():
    """A red box on the ground ahead, a gate beside it, and a picture that may be replaced."""
    made = World(WorldDescription(
        models=(box("box", (2.0, 0.0, -0.2), static=True), GATE,
                box("screen", (2.0, -0.8, 0.0), FILM, static=True)),
        scenery=(("ground", GROUND),), lights=(SUN,), gravity=(0.0, 0.0, 0.0)))
    made.scene.images["film"] = np.full((4, 4, 3), 90, np.uint8)
    made.spawn(ModelDescription("eye", static=True, links=(LinkDescription("l"),)))
    yield made
    made.close()


def camera(world, renderer, description=SMALL, kind="camera"):
    sensor = SensorDescription("s", kind, cameras=(description,))
    return Camera(world, world.link("eye::l"), sensor, renderer)


def add_blue_box(world):
    world.spawn(box("new", (1.5, 0.2, 0.0), Material(diffuse=(0.0, 0.0, 1.0, 1.0)), static=True))


CHANGES = {
    "a model is moved": lambda world: world.model("box").set_pose(Pose((2.0, 0.3, -0.2))),
    "a joint turns": lambda world: world.model("gate").joints["hinge"].reset(0.7),
    "the camera is moved": lambda world: world.model("eye").set_pose(Pose((0.1, 0.0, 0.0))),
    "a model is spawned": add_blue_box,
    "a model is deleted": lambda world: world.delete("box"),
    "a light is added": lambda world: world.scene.add_light(
        replace(SUN, name="lamp", diffuse=(0.0, 0.5, 0.0, 1.0), cast_shadows=False)),
    "a light is changed": lambda world: world.scene.change_light(
        replace(SUN, direction=(-0.5, 0.0, -1.0))),
    "a light is removed": lambda world: world.scene.remove_light("sun"),
    "a visual is added": lambda world: world.scene.add_visual(
        ("box", "l"), Visual("more", Box((0.2, 0.9, 0.2)))),
    "another image is on a screen": lambda world: world.scene.images.update(
        film=np.full((4, 4, 3), 200, np.uint8)),
    "a joint goes on turning": lambda world: turn_and_wait(world, "gate"),
}


def turn_and_wait(world, name):
    world.model(name).joints["hinge"].drive_velocity(1.0, 10.0)
    world.step(100)


def drawn_alone(world, renderer, depth=False, **options):
    """What a camera that has drawn nothing yet sees."""
    return camera(world, renderer, **options).sample(depth)


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_what_changes_a_picture_draws_it_anew(scene, renderer, change):
    counting = Counting(renderer)
    eye = camera(scene, counting)
    before = eye.sample().rgb
    change(scene)
    after = eye.sample().rgb
    assert counting.count == 2 and not np.array_equal(before, after)
    assert np.array_equal(after, drawn_alone(scene, renderer).rgb)


@pytest.mark.parametrize("options", [
    {}, {"description": NOISY}, {"description": BENT},
    {"description": WIDE, "kind": "wideanglecamera"}],
    ids=["plain", "noisy", "distorted", "wide"])
def test_what_has_not_changed_is_not_drawn_and_has_equal_bits(scene, renderer, options):
    counting = Counting(renderer)
    eye = camera(scene, counting, **options)
    scene.step(600)  # until nothing moves any more
    eye.sample()
    first = counting.count
    for _ in range(3):
        scene.step(33)
        scene.model("box").set_pose(scene.model("box").pose)
        reading = eye.sample()
        assert reading.time == scene.time
        assert np.array_equal(reading.rgb, drawn_alone(scene, renderer, **options).rgb)
    assert counting.count == first


def test_noise_is_new_in_each_picture(scene, renderer):
    counting = Counting(renderer)
    eye = camera(scene, counting, NOISY)
    pictures = []
    for _ in range(3):
        pictures.append(eye.sample().rgb)
        scene.step()
    assert counting.count == 1
    assert len({picture.tobytes() for picture in pictures}) == 3


def test_depth_is_drawn_if_the_last_picture_had_none_and_the_reverse(scene, renderer):
    """Its colours may have other details."""
    counting = Counting(renderer)
    eye = camera(scene, counting)
    for count, depth in ((1, False), (2, True), (2, True), (3, False)):
        reading = eye.sample(depth)
        alone = drawn_alone(scene, renderer, depth)
        assert counting.count == count and np.array_equal(reading.rgb, alone.rgb)
        assert (reading.depth is not None) == depth
        if depth:
            assert np.array_equal(reading.depth, alone.depth)


def test_each_camera_remembers_its_own_picture(scene, renderer):
    counting = Counting(renderer)
    eyes = [camera(scene, counting, each) for each in (
        SMALL, replace(SMALL, pose=Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.3))))]
    first = [eye.sample().rgb for eye in eyes]
    again = [eye.sample().rgb for eye in eyes]
    assert counting.count == 2 and not np.array_equal(*first)
    assert all(map(np.array_equal, first, again))


def test_a_camera_that_is_described_anew_is_drawn_anew(scene, renderer):
    counting = Counting(renderer)
    eye = camera(scene, counting)
    before = eye.sample().rgb
    eye.description = wider = replace(SMALL, horizontal_fov=1.5)
    after = eye.sample().rgb
    assert counting.count == 2 and not np.array_equal(before, after)
    assert np.array_equal(after, drawn_alone(scene, renderer, description=wider).rgb)


def test_the_first_image_of_a_screen_is_another_look(scene):
    scene.scene.images.clear()
    dark = scene.scene.look()
    scene.scene.images["film"] = np.zeros((4, 4, 3), np.uint8)
    assert not dark.equals(scene.scene.look()) and not scene.scene.look().equals(dark)
    assert scene.scene.look().equals(scene.update_scene().frozen().look())


def test_who_walks_is_drawn_at_every_place(scene, renderer):
    counting = Counting(renderer)
    eye = camera(scene, counting)
    scene.spawn(box("walker", (0.0, 0.0, 0.0), static=True, trajectory=Trajectory(
        ((0.0, Pose((1.5, -0.5, 0.0))), (9.0, Pose((1.5, 0.5, 0.0)))))))
    seen = set()
    for _ in range(4):
        scene.step(100)
        seen.add(eye.sample().rgb.tobytes())
    assert counting.count == len(seen) == 4


def test_a_sampled_picture_is_the_callers_own(scene, renderer):
    eye = camera(scene, renderer)
    first, clean = eye.sample(depth=True), drawn_alone(scene, renderer, depth=True)
    first.rgb[:], first.depth[:] = 0, 0.0
    again = eye.sample(depth=True)
    assert np.array_equal(again.rgb, clean.rgb) and np.array_equal(again.depth, clean.depth)


@pytest.mark.parametrize("seed", range(3))
def test_a_history_in_which_pictures_are_left_out_has_the_same_bits(scene, renderer, seed):
    """Against a camera that draws each time."""
    random = np.random.default_rng(seed)
    counting, every = Counting(renderer), Counting(renderer)
    eye, drawing = camera(scene, counting), camera(scene, every)
    for _ in range(30):
        if random.random() < 0.5:
            name = random.choice(["box", "screen", "eye"])
            ahead = 0.0 if name == "eye" else 2.0
            scene.model(name).set_pose(Pose((ahead, *random.uniform(-0.2, 0.2, 2))))
        state = eye.capture()
        assert np.array_equal(eye.render(state).rgb, drawing.render(state, anew=True).rgb)
    assert 5 < counting.count < 25 and every.count == 30


def test_a_deleted_model_is_not_kept_in_memory_for_the_next_picture(scene, renderer):
    eye = camera(scene, renderer)
    eye.sample()
    shape = weakref.ref(scene.scene.nodes["gate", "leaf"].shape)
    scene.delete("gate")
    renderer.trim()
    gc.collect()
    assert shape() is None
