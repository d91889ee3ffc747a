"""Pictures to learn from: the same from the same seed, with boxes where the things are."""

import math
from dataclasses import replace

import numpy as np
import pytest
from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.dataset import (
    INPUT_HEIGHT,
    INPUT_WIDTH,
    holds,
    read_sets,
    write_set,
)
from ai_robot_tracking.training.drawing import Stage, draw_picture, draw_stage
from ai_robot_tracking.training.main import main
from ai_robot_tracking.training.things import MAKERS, Thing, bar, box, coloured

from bullet_sim.description import SceneDescription
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer

HIGH = 0.3  # m, of the camera
VIEW = CameraView(640, 480, 1.2, 0.05, 100.0, Pose((0.0, 0.0, HIGH)))
RADIUS, LENGTH, AWAY = 0.2, 0.6, 3.0  # m


@pytest.fixture(scope="module")
def renderer():
    found = open_renderer()
    yield found
    found.close()


FLOOR = box((60.0, 60.0, 0.1), (0, 0, -0.05), coloured((0.4, 0.4, 0.4)))


def stage_with(*things):
    return Stage(VIEW, SceneDescription(), [], (FLOOR,), list(things))


def standing_cylinder():
    part = bar(RADIUS, LENGTH, (0, 0, LENGTH / 2), coloured((1, 0, 0)))
    return Thing("cylinder", (part,), (), Pose((AWAY, 0.0, 0.0)), RADIUS)


def screen(width, left, away=2.0):
    part = box((0.02, width, 3.0), (0, 0, 0), coloured((0, 0, 1)))
    return Thing(None, (part,), (), Pose((away, left, HIGH)), width)


def test_a_seed_gives_the_same_picture_and_another_seed_another(renderer):
    first, again, other = (draw_picture(renderer, seed) for seed in (11, 11, 12))
    assert (first.rgb == again.rgb).all() and (first.labels == again.labels).all()
    assert first.rgb.shape != other.rgb.shape or (first.rgb != other.rgb).any()


def test_a_cylinders_box_is_where_it_must_be(renderer):
    (label,) = draw_stage(renderer, stage_with(standing_cylinder()), 1).labels
    focal = VIEW.focal_length_px
    half_width = focal * math.tan(math.asin(RADIUS / AWAY))
    up, down = (focal * height / (AWAY - RADIUS) for height in (LENGTH - HIGH, HIGH))
    expected = (320 - half_width, 240 - up, 320 + half_width, 240 + down)
    np.testing.assert_allclose(label[1:5], expected, atol=1.2)
    assert CLASSES[int(label[0])] == "cylinder" and label[5] == 1


@pytest.mark.parametrize("hidden, counts", [(0.3, 1), (0.45, 1), (0.55, 0), (0.9, 0)])
def test_a_box_holds_what_is_seen_and_counts_from_a_half_on(renderer, hidden, counts):
    # The screen hides all left of a line through the cylinder's picture.
    line = 2.0 * (1 - 2 * hidden) * math.tan(math.asin(RADIUS / AWAY))
    stage = stage_with(standing_cylinder(), screen(2.0, line + 1.0))
    (label,) = draw_stage(renderer, stage, 2).labels
    assert label[1] == pytest.approx(320 - line / 2.0 * VIEW.focal_length_px, abs=2.5)
    assert label[5] == counts


def test_what_is_small_or_outside_does_not_count(renderer):
    far = replace(standing_cylinder(), pose=Pose((25.0, 0.0, 0.0)))  # 7 px wide
    cut = replace(standing_cylinder(), pose=Pose((AWAY, 2.18, 0.0)))
    beside = replace(standing_cylinder(), pose=Pose((AWAY, 9.0, 0.0)))
    labels = draw_stage(renderer, stage_with(far, cut, beside), 3).labels
    assert labels[:, 5].tolist() == [0, 0]


@pytest.mark.parametrize("label", CLASSES)
def test_each_thing_stands_on_the_floor_and_is_seen(renderer, label):
    rng = np.random.default_rng(5)
    for seed in range(6):
        images = {}
        thing = MAKERS[label](rng, images)
        parts = (*thing.own, *thing.support)
        lowest = min(float(part.vertices[:, 2].min()) for part in parts)
        assert -0.12 < lowest < 0.15
        corners = np.concatenate([part.vertices for part in thing.own])
        middle, size = float(corners[:, 2].mean()), float(np.ptp(corners, axis=0).max())
        # Before the camera at its own height, above a floor far below.
        pose = Pose.from_xyz_rpy((2.5 * size, 0, HIGH - middle), (0, 0, math.pi))
        stage = replace(stage_with(replace(thing, pose=pose)), images=images,
                        surroundings=(box((60.0, 60.0, 0.1), (0, 0, -9.0), FLOOR.material),))
        (found,) = draw_stage(renderer, stage, 100 + seed).labels
        assert CLASSES[int(found[0])] == label and found[5] == 1


def test_a_damaged_set_is_drawn_again_and_never_read(tmp_path):
    path = tmp_path / "train-1000000.npz"
    write_set(path, [(np.zeros((INPUT_HEIGHT, INPUT_WIDTH, 3), np.uint8), np.zeros((1, 6)))], 7)
    assert holds(path, 1) and len(read_sets(tmp_path, "train")) == 1
    path.write_bytes(path.read_bytes()[:-40])
    assert not holds(path, 1)
    with pytest.raises(OSError, match=r"train-1000000\.npz: not a set of images"):
        read_sets(tmp_path, "train")


@pytest.mark.parametrize("option", [["--pictures", "0"], ["--pictures", "\u0663"],
                                    ["--seed", "-1"], ["--seed", "x"]])
def test_a_number_that_is_none_is_one_line(option, capsys):
    assert main(["train", "folder", "model.onnx", *option]) == 2
    assert capsys.readouterr().err.count("\n") == 1
