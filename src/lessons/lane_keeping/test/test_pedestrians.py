"""How people cross, that a seed repeats a walk, and what pedestrians.py says of each mistake."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
import yaml
from lane_keeping.walking import Crossing, Habits, Stage, Walker

PACKAGE = Path(__file__).parents[1]
CROSSINGS = PACKAGE / "config" / "crossings.yaml"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("pedestrians", PACKAGE / "scripts/pedestrians.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_without_parameters_the_packages_file_and_numbers_count(script):
    path, near, seed = script.read_parameters({})
    assert (Path(path).resolve(), near, seed) == (CROSSINGS.resolve(), 0.0, 0)
    assert len(script.read_crossings(path)) == 4


@pytest.mark.parametrize("given, said", [
    ({"nera": 3}, "unknown parameter ~nera"),
    ({"near": "three"}, "~near must be a number from 0 on, m, not 'three'"),
    ({"near": float("nan")}, "~near must be"),
    ({"seed": -1}, "~seed must be a whole number"),
    ({"seed": 1.5}, "~seed must be a whole number"),
])
def test_wrong_parameters_are_one_line(script, given, said):
    with pytest.raises(SystemExit) as ended:
        script.read_parameters(given)
    assert said in str(ended.value) and "\n" not in str(ended.value)


@pytest.mark.parametrize("change, said", [
    ({"kreb": 1}, "key 'kreb' is missing or unknown"),
    ({"kerb": "wide"}, "'kerb' must be a number, not 'wide'"),
    ({"far": 10**400}, "'far' must be a number"),
    ({"zebras": [{"x": 1, "y": 2}]}, "zebra 1: key 'heading' is missing or unknown"),
    ({"zebras": [{"x": 1, "y": 2, "heading": 0, "yaw": 0}]}, "zebra 1: key 'yaw' is missing or"),
    ({"zebras": 7}, "not iterable"),
])
def test_mistakes_in_the_file_are_one_line(script, tmp_path, change, said):
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(yaml.safe_load(CROSSINGS.read_text("utf-8")) | change))
    with pytest.raises(SystemExit) as ended:
        script.read_crossings(path)
    assert str(path) in str(ended.value) and said in str(ended.value)


@pytest.mark.parametrize("text", ["[1, 2]", "a: [", "kerb: 2026-13-45", ""])
def test_no_table_is_one_line(script, tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    with pytest.raises(SystemExit, match=r"mine\.yaml: "):
        script.read_crossings(path)


def test_pictures_are_asked_for_before_answers_are_announced(script, monkeypatch):
    """Lockstep begins when all announced links are open; one announced late misses a picture."""
    asked = []
    monkeypatch.setattr(script.rospy, "Subscriber", lambda topic, *_, **__: asked.append(topic))
    monkeypatch.setattr(script.rospy, "Publisher", lambda topic, *_, **__: asked.append(topic))
    script.Pedestrians(script.read_crossings(CROSSINGS), script.Habits(), 0)
    first_answer = next(n for n, topic in enumerate(asked) if topic.endswith("cmd_vel"))
    assert asked.index("camera_info") < first_answer


CROSSING = Crossing(x=2.0, y=1.0, heading=0.0, length=0.8, kerb=0.85, far=1.4)
PERIOD = 1 / 30  # s
NEAR_EDGE = 1.6  # m, x


def walk(car, habits=Habits(), seed=0, seconds=30.0):
    """Times and places (m left of the lane) of a person; car: function of time to x, y, speed."""
    walker, left, track = Walker(CROSSING, habits, np.random.default_rng(seed)), -1.4, []
    for time in np.arange(0, seconds, PERIOD):
        left += walker.step(time, (CROSSING.x, CROSSING.y + left), car(time)) * PERIOD
        track.append((time, left, walker.stage))
    return track


def standing(front, speed=0.0):
    """A car whose front is so far before the zebra."""
    return lambda _time: (NEAR_EDGE - front - 0.2, 1.0, speed)


def test_people_walk_to_and_fro_when_no_car_comes():
    track = walk(lambda _time: None)
    places = [left for _, left, _ in track]
    assert max(places) >= 1.4 and min(places[200:]) < 0.0
    assert max(np.abs(np.diff(places))) <= 1.2 * PERIOD + 1e-9


def test_nobody_steps_out_close_before_a_car_that_drives():
    track = walk(standing(0.5, speed=0.8))
    assert max(left for _, left, _ in track) < -0.85 + 0.05
    assert track[-1][2] is Stage.LOOKING


def test_people_cross_before_a_car_that_stands_or_is_far_or_has_passed():
    for car in (standing(0.4), standing(3.0, 0.8), standing(-1.5, 0.8),
                lambda _time: (1.0, 9.0, 0.8)):
        assert max(left for _, left, _ in walk(car)) > 1.3


def test_nobody_steps_out_onto_a_car_that_stands_on_the_zebra():
    assert max(left for _, left, _ in walk(standing(-0.3))) < 0


def test_with_near_people_wait_for_a_car():
    habits = Habits(near=3.0)
    assert {stage for *_, stage in walk(standing(4.0, 0.5), habits)} == {Stage.WAITING}
    assert max(left for _, left, _ in walk(standing(0.9, 0.0), habits)) > 1.3


def test_a_seed_repeats_its_walks():
    assert walk(standing(2.0), seed=4) == walk(standing(2.0), seed=4)
    assert walk(standing(2.0), seed=4) != walk(standing(2.0), seed=5)


def test_people_walk_again_after_the_clock_was_set_back():
    walker = Walker(CROSSING, Habits(), np.random.default_rng(0))
    walker.step(500.0, (CROSSING.x, CROSSING.y - 1.4), None)
    walker.step(500.1, (CROSSING.x, CROSSING.y + 1.5), None)
    speeds = [walker.step(time, (CROSSING.x, CROSSING.y - 1.4), None)
              for time in np.arange(0, 9, PERIOD)]
    assert any(speeds)
