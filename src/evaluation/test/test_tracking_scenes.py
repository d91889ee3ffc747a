"""The scenes: what a seed draws, what the world files say, and that the follower manages them.

The drives are those of kinematic_tracker.py: the simulator's own pictures, no physics.
"""

import math
import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import rospkg
from ai_robot_tracking.follower import Follower, FollowerSettings
from ai_robot_tracking.scenes.scene import (
    HALF_REACH,
    HIDDEN_TIME,
    KINDS,
    OCCLUSION,
    SPEED,
    STATIC,
    Scene,
    draw_scene,
    draw_start,
)
from ai_robot_tracking.scenes.world_file import TARGET, world_name, world_text
from kinematic_tracker import follow
from node_basics.settings import load_settings

from bullet_sim.actors import pose_at
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from evaluation.track_score import FIND_TIME, Task, TrackScorer

LESSON = Path(rospkg.RosPack().get_path("ai_robot_tracking"))
CONFIG = LESSON / "config" / "tracking_params.yaml"
MOVING_KINDS = [kind for kind in KINDS if kind != STATIC]


@pytest.mark.parametrize("kind", MOVING_KINDS)
def test_the_way_is_the_seeds_at_an_even_speed_inside_the_room(kind):
    for seed in range(20):
        way = draw_scene(kind, seed).way
        assert (way == draw_scene(kind, seed).way).all()
        steps = np.linalg.norm(np.diff(way[:, 1:], axis=0), axis=1) / np.diff(way[:, 0])
        assert steps == pytest.approx(SPEED)
        assert np.abs(way[:, 1:]).max() < HALF_REACH + 0.75
        assert np.linalg.norm(way[0, 1:]) > 1.4
    assert not (draw_scene(kind, 0).way == draw_scene(kind, 1).way).all()


@pytest.mark.parametrize("kind", KINDS)
def test_the_lessons_worlds_are_those_of_seed_0(kind):
    shipped = LESSON / "worlds" / f"{world_name(kind)}.world"
    assert shipped.read_text(encoding="utf-8") == world_text(draw_scene(kind, 0))


@pytest.mark.parametrize("kind", KINDS)
def test_the_simulator_reads_the_way_that_is_scored(kind, tmp_path):
    scene = draw_scene(kind, 3)
    models = {model.name: model for model in read(scene, tmp_path).models}
    task = Task(scene.way, scene.hidden, 1.2)
    for time in (0.0, 0.3, 17.77, 100.0):
        found = models[TARGET].pose if kind == STATIC else pose_at(models[TARGET].trajectory, time)
        assert found.position[:2] == pytest.approx(task.target(time), abs=1e-3)


def test_the_hood_is_down_over_the_cylinder_for_3_s(tmp_path):
    scene = draw_scene(OCCLUSION, 1)
    models = {model.name: model for model in read(scene, tmp_path).models}
    for begin in scene.hidden:
        for time in np.arange(begin, begin + HIDDEN_TIME, 0.1):
            hood = pose_at(models["hood"].trajectory, time).position
            assert hood[:2] == pytest.approx(pose_at(models[TARGET].trajectory, time).position[:2],
                                             abs=0.02)
            assert hood[2] < 0.4
        for time in (begin - 0.3, begin + HIDDEN_TIME + 0.3):
            assert pose_at(models["hood"].trajectory, time).position[2] > 2.0


@pytest.mark.parametrize("kind", KINDS)
def test_the_follower_keeps_its_distance(kind, tmp_path):
    settings = load_settings(FollowerSettings, CONFIG, "visual_tracker_pid", {})
    drive = chase(kind, 2, Follower(settings).drive, settings.wanted_distance, tmp_path)
    assert drive.outcome == "kept"
    assert all(hiding.found_after < FIND_TIME for hiding in drive.hidings)
    assert np.sqrt(np.mean(drive.judged_errors() ** 2)) < 0.15


def test_the_plain_tracker_reaches_what_stands(tmp_path):
    page = runpy.run_path(str(CONFIG.parents[1] / "scripts" / "visual_tracker.py"))
    numbers = SimpleNamespace(**page["PAGE"])

    def law(picture: np.ndarray, _time: float) -> tuple[float, float]:
        circle = page["largest_circle"](page["red_mask"](picture, numbers))
        return page["command_to"](circle, picture.shape[1], numbers)

    assert chase(STATIC, 2, law, None, tmp_path).outcome == "reached"


def test_standing_still_is_no_following(tmp_path):
    drive = chase("moving", 2, lambda _picture, _time: (0.0, 0.0), 1.2, tmp_path)
    assert not drive.good


def chase(kind, seed, law, wanted, folder):
    """The scored drive, of 8 s, or until it was hidden twice."""
    scene, start = draw_scene(kind, seed), draw_start(kind, seed)
    drive = TrackScorer(Task(scene.way, scene.hidden, wanted, keep=8.0))
    follow(scene, folder, law, drive, (start.x, start.y, start.yaw))
    return drive


def read(scene: Scene, folder: Path):
    path = folder / "scene.world"
    path.write_text(world_text(scene), encoding="utf-8")
    return load_world(path, Resources.from_environment())


def test_starts_differ_and_keep_clear_of_the_cylinder():
    starts = [draw_start(STATIC, seed) for seed in range(20)]
    assert len(set(starts)) == 20
    assert all(math.dist((each.x, each.y), draw_scene(STATIC, 0).way[0, 1:]) >= 1.5
               for each in starts)
