"""Race-v0, Lane-v0 and Track-v0, the files that describe them, and the examples."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from driving_courses.course import FOLDER, FeatureSpec, load_course
from driving_courses.errors import CourseError
from driving_courses.features import find_features
from driving_courses.packages import FOLDERS, find_package
from driving_courses.policy import LinearPolicy, load_policy
from gymnasium.utils.env_checker import check_env

import driving_courses

HERE = Path(__file__).resolve().parent.parent
POLICY = HERE / "policies" / "line_follow.json"


def make(course, **options):
    return gymnasium.make(f"driving_courses/{course}-v0", **options)


def race(features, _info):
    """By the line half a metre ahead; slower than the car can."""
    return 1.0, -0.5 * features[4]


def lane(features, _info):
    """Between the dark lines; by one of them where the other is not seen."""
    left, right = features[6:9], features[9:12]  # of the second band: seen, column, share
    middle = (left[1] if left[0] else -0.57) + (right[1] if right[0] else 0.57)
    return 0.5, -1.5 * middle


def track(features, info):
    """Turns to the cylinder and keeps away from it what the environment says."""
    return 2.5 * info["error_m"], -2.5 * features[1]


def drive(env, law, steps):
    features, info = env.reset(seed=0)
    total = 0.0
    for _ in range(steps):
        action = np.clip(law(features, info), env.action_space.low, env.action_space.high)
        features, reward, over, _, info = env.step(action.astype(np.float32))
        total += reward
        if over:
            break
    env.close()
    return total, info


@pytest.mark.parametrize(("course", "law", "least"), [("Race", race, 9.0), ("Lane", lane, 4.0)])
def test_a_simple_law_stays_on_the_course(course, law, least):
    total, info = drive(make(course, observation="features", timestep=0.002), law, 300)
    assert info["outcome"] == "driving", info
    assert info["progress_m"] > least
    assert 0.5 * info["progress_m"] < total


def test_a_simple_law_keeps_its_distance_to_the_cylinder():
    total, info = drive(make("Track", observation="features", timestep=0.004), track, 450)
    assert info["outcome"] == "driving", info
    assert info["rms_error_m"] < 0.25
    assert total > 2.0


def test_who_stands_does_not_keep_the_distance():
    _, info = drive(make("Track", observation="features", size=(16, 12), timestep=0.004),
                    lambda *_: (0.0, 0.0), 1200)
    assert info["outcome"] in ("not reached", "distance not kept")


@pytest.mark.parametrize("course", ["Race", "Lane", "Track"])
def test_gymnasium_has_nothing_to_say_against_it(course):
    env = make(course, size=(40, 30), render_mode="rgb_array")
    check_env(env.unwrapped, skip_render_check=False)
    env.close()


@pytest.mark.parametrize("course", ["Race", "Track"])
def test_random_ones_differ(course):
    seen = set()
    for seed in (3, 4):
        env = make(course, size=(64, 48), randomise={"tracks": (seed,)})
        seen.add(env.reset(seed=0)[0].tobytes())
        env.close()
    assert len(seen) == 2


def test_a_course_without_random_tracks_says_so():
    env = make("Lane", size=(16, 12), randomise={"tracks": (1,)})
    with pytest.raises(CourseError, match="no random ones"):
        env.reset(seed=0)
    env.close()


def test_a_steering_angle_and_a_rate_of_yaw_mean_the_same_bend():
    ends = []
    for action, turn in (("ackermann", 0.2), ("twist", 0.5 * np.tan(0.2) / 0.335)):
        env = make("Race", size=(16, 12), action=action)
        env.reset(seed=0)
        for _ in range(20):
            env.step(np.array([0.5, turn], np.float32))
        ends.append(env.unwrapped._simulation.sample())
        env.close()
    assert ends[0].yaw == pytest.approx(ends[1].yaw, abs=1e-3)
    assert ends[0].yaw > 0.1


def test_every_course_is_named_and_every_package_found():
    named = {options["course"] for options in driving_courses.ENVIRONMENTS.values()}
    assert named == {path.stem for path in FOLDER.glob("*.yaml")}
    assert all((find_package(name) / "package.xml").exists() for name in FOLDERS)
    with pytest.raises(CourseError, match="no package 'nobody'"):
        find_package("nobody")


@pytest.mark.parametrize(("old", "new", "said"), [
    ("turn:", "trun:", "unknown key 'trun'"),
    ("task: lap", "task: fly", "task: must be one of"),
    ("turn: 1.5", "turn: -1", "turn: must be a number above 0"),
    ("speeds: [0, 0.4]", "speeds: [0.1, 0.4]", "speeds: must be"),
    ("size: [160, 90]", "size: [160]", "size: must be two whole numbers"),
    ("halves: false", "halves: no way", "halves: must be true or false"),
    ("[0.66, 0.68]", "[0.68, 0.66]", "bands: must be"),
])
def test_a_mistake_in_a_course_file_names_file_and_key(tmp_path, old, new, said):
    text = (FOLDER / "line_follow.yaml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "mine.yaml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(CourseError, match=f"{path}: .*{said}" if ":" not in said else said):
        load_course(path)


@pytest.mark.parametrize("text", ["a: 2020-13-45", "a: !!int ''", "a: !!bool x", "[" * 1000])
def test_what_the_yaml_parser_gives_up_on_is_no_yaml(tmp_path, text):
    (tmp_path / "mine.yaml").write_text(text)
    with pytest.raises(CourseError, match=r"mine\.yaml: not valid YAML: [^\n]{1,300}$"):
        load_course(tmp_path / "mine.yaml")


def test_features_say_where_the_colour_is():
    spec = FeatureSpec((40, 20), (175, 100, 100), (5, 255, 255), ((0.0, 0.5), (0.5, 1.0)), False)
    picture = np.zeros((20, 40, 3), np.uint8)
    picture[:10, 30:] = (255, 0, 0)  # red: its hue is 0
    picture[:5, 30:] = (255, 0, 20)  # and hue 177
    np.testing.assert_allclose(find_features(picture, spec), [1, 0.75, 0.25, 0, 0, 0], atol=0.02)
    halves = FeatureSpec((40, 20), spec.lower, spec.upper, ((0.0, 0.5),), True)
    np.testing.assert_allclose(find_features(picture, halves), [0, 0, 0, 1, 0.75, 0.5], atol=0.02)


def test_a_policy_is_read_as_it_was_written(tmp_path):
    policy = LinearPolicy("race", "ackermann", [[0.0, 1.0], [2.0, 0.0]], [0.5, 0.0],
                          [0.0, -0.3], [1.0, 0.3], {})
    policy.save(tmp_path / "p.json")
    assert load_policy(tmp_path / "p.json") == policy
    assert policy.act(np.array([1.0, 0.2])) == pytest.approx((0.7, 0.3))
    (tmp_path / "p.json").write_text('{"course": "race"}')
    with pytest.raises(CourseError, match="must have the keys"):
        load_policy(tmp_path / "p.json")


@pytest.mark.parametrize("weights", ["[" * 10**5, "[1, 2]", "[[1], [1" + "0" * 400 + "]]", "{}"])
def test_a_file_without_two_rows_of_weights_is_no_policy(tmp_path, weights):
    path = tmp_path / "p.json"
    path.write_text('{"course": "race", "action": "ackermann", "score": {}, "bias": [0, 0],'
                    f' "low": [0, 0], "high": [1, 1], "weights": {weights}}}')
    with pytest.raises(CourseError, match=r"p\.json: [^\n]+$"):
        load_policy(path)


def test_the_shipped_policy_drives_as_its_file_says():
    policy = load_policy(POLICY)
    _, info = drive(make("LineFollow", observation="features"),
                    lambda features, _: policy.act(features), 4000)
    assert info["outcome"] == policy.score["outcome"] == "closed"
    assert info["lap_times_s"] == pytest.approx(policy.score["lap_times_s"], rel=0.01)
    assert info["rms_lateral_m"] == pytest.approx(policy.score["rms_lateral_m"], rel=0.1)


def test_the_search_runs_and_writes_a_policy(tmp_path):
    example = HERE / "examples" / "train_cem.py"
    assert len(example.read_text(encoding="utf-8").splitlines()) <= 90
    done = subprocess.run(
        [sys.executable, example, tmp_path / "p.json", "--generations", "1", "--seconds", "1"],
        capture_output=True, text=True, check=False, timeout=280)
    assert done.returncode == 0, done.stderr
    assert load_policy(tmp_path / "p.json").course == "line_follow"


@pytest.mark.parametrize(("words", "says"), [
    (["--course", "Line"], "invalid choice: 'Line' (choose from 'LineFollow', "),
    (["--generations", "0"], "--generations must be 1 or more"),
    (["/proc/p.json"], "/proc/p.json: No such file or directory")])
def test_a_search_that_cannot_begin_is_one_line(words, says):
    done = subprocess.run([sys.executable, HERE / "examples" / "train_cem.py", *words],
                          capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2 and says in done.stderr.splitlines()[-1]


@pytest.mark.skipif(importlib.util.find_spec("stable_baselines3") is None,
                    reason="stable-baselines3 brings PyTorch, which setup does not install")
def test_stable_baselines3_learns_a_thousand_steps(tmp_path):
    done = subprocess.run(
        [sys.executable, HERE / "examples" / "train_ppo.py", "--steps", "1000",
         "--out", tmp_path / "ppo"], capture_output=True, text=True, check=False, timeout=280)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "ppo.zip").exists()
