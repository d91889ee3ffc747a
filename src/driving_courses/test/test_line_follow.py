"""LineFollow-v0: what is seen, what counts, when it ends, and that a seed repeats it to the bit."""

import dataclasses
import os
import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from driving_courses.errors import CourseError
from driving_courses.randomisation import TRIALS
from gymnasium.utils.env_checker import check_env

import driving_courses  # noqa: F401  (names the environments)
from bullet_sim.rendering.renderer import open_renderer
from driving_courses import simulation

LINE = "driving_courses/LineFollow-v0"
SPEED, GAIN = 0.15, 1.2  # m/s; rad/s for a line at the picture's edge
MIDDLE = -0.1  # the line's column when the robot stands on it: the camera is right of its middle


def make(**options):
    return gymnasium.make(LINE, **options)


def steer(features):
    """Keeps the line of the second band where it is on the line."""
    return np.array([SPEED, -GAIN * (features[4] - MIDDLE)], np.float32)


def record(env, seed, steps=20):
    """All observations, rewards and reports of some steps from a seed."""
    env.action_space.seed(seed)
    observation, info = env.reset(seed=seed)
    found = [observation.tobytes(), info]
    for _ in range(steps):
        observation, *rest = env.step(env.action_space.sample())
        found += [observation.tobytes(), *rest]
    return found


def test_a_follower_closes_the_lap_and_its_reward_is_the_way():
    env = make(observation="features", timestep=0.004)
    features, _ = env.reset(seed=0)
    total, over = 0.0, False
    while not over:
        features, reward, over, late, info = env.step(steer(features))
        total += reward
        assert not late
    env.close()
    assert info["outcome"] == "closed"
    assert 55 < info["lap_times_s"][0] < 75
    assert info["rms_lateral_m"] < 0.06
    assert 0.75 * info["progress_m"] < total < info["progress_m"]


def test_who_does_not_steer_leaves_the_course():
    env = make(observation="features", size=(32, 18), timestep=0.004)
    env.reset(seed=0)
    over = False
    while not over:
        _, reward, over, _, info = env.step(np.array([0.4, 0.0], np.float32))
    env.close()
    assert info["outcome"] == "left the course"
    assert reward < -0.9


def test_who_does_not_drive_is_truncated_or_stalls():
    env = make(observation="features", size=(32, 18), duration=0.5)
    env.reset(seed=0)
    ends = [env.step(np.zeros(2, np.float32))[2:4] for _ in range(15)]
    env.close()
    assert ends == [(False, False)] * 14 + [(False, True)]


@pytest.mark.parametrize(("observation", "action"), [("image", "twist"),
                                                     ("features", "ackermann")])
def test_gymnasium_has_nothing_to_say_against_it(observation, action):
    env = make(observation=observation, action=action, size=(40, 30), render_mode="rgb_array")
    check_env(env.unwrapped, skip_render_check=False)
    env.close()


def test_pictures_have_the_size_that_is_asked_for():
    env = make(size=(64, 48))
    picture, _ = env.reset(seed=0)
    env.close()
    assert picture.shape == (48, 64, 3)
    assert picture.dtype == np.uint8
    assert np.ptp(picture) > 100  # not one grey


def test_a_seed_gives_equal_bits_and_another_one_others():
    env = make(size=(40, 30), randomise=TRIALS)
    first = record(env, 5)
    other, again = record(env, 6), record(env, 5)
    env.close()
    fresh = make(size=(40, 30), randomise=TRIALS)
    assert record(fresh, 5) == first == again
    assert other != first
    fresh.close()


def vector(context, **options):
    return gymnasium.make_vec(LINE, num_envs=2, vectorization_mode="async",
                              vector_kwargs={"context": context}, **options)


def test_vectors_of_processes_see_what_one_process_sees():
    options = {"size": (40, 30), "randomise": TRIALS}
    envs = vector("spawn", **options)
    actions = np.array([[0.3, 0.5], [0.2, -0.5]], np.float32)
    seen = [envs.reset(seed=[5, 6])[0], *(envs.step(actions)[0] for _ in range(5))]
    envs.close()
    env = make(**options)
    for number, seed in enumerate((5, 6)):
        mine = [env.reset(seed=seed)[0], *(env.step(actions[number])[0] for _ in range(5))]
        for theirs, own in zip(seen, mine, strict=True):
            np.testing.assert_array_equal(theirs[number], own)
    env.close()


@pytest.mark.parametrize("size, own, wanted", [
    ((84, 84), None, "0"), ((84, 84), "2", "2"), ((640, 480), None, None)])
def test_small_pictures_are_drawn_without_threads_unless_somebody_says_how_many(
        monkeypatch, size, own, wanted):
    seen = []
    monkeypatch.setattr(simulation, "open_renderer",
                        lambda: seen.append(os.environ.get("LP_NUM_THREADS")) or open_renderer())
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    if own:
        monkeypatch.setenv("LP_NUM_THREADS", own)
    env = make(size=size)
    env.reset(seed=0)
    env.close()
    assert seen == [wanted] and os.environ.get("LP_NUM_THREADS") == own


def test_a_process_that_draws_nothing_may_be_forked_and_another_says_what_to_do():
    code = (f"import gymnasium, driving_courses; envs = gymnasium.make_vec('{LINE}', num_envs=2, "
            "vectorization_mode='async', vector_kwargs={'context': 'fork'}, size=(16, 12)); "
            "print(envs.reset(seed=0)[0].shape); envs.close()")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False,
                          timeout=200)
    assert done.stdout.strip() == "(2, 12, 16, 3)", done.stderr
    env = make(size=(16, 12))
    env.reset(seed=0)
    env.close()
    envs = vector("fork", size=(16, 12))
    with pytest.raises(CourseError, match="'context': 'spawn'"):
        envs.reset(seed=0)
    envs.close(terminate=True)


def picture(randomise, seed=3, **options):
    env = make(size=(64, 48), randomise=randomise, **options)
    seen, _ = env.reset(seed=seed)
    env.close()
    return seen.astype(int)


def test_light_makes_the_ground_darker_or_brighter():
    ground = [picture(light)[24:].mean() for light in (
        {"light": (0.5, 0.5)}, None, {"light": (1.5, 1.5)})]
    assert ground[0] < 0.7 * ground[1]
    assert ground[2] > 1.3 * ground[1]


def test_camera_noise_is_as_strong_as_asked_for():
    grain = picture({"camera_noise": (0.05, 0.05)}) - picture(None)
    assert 0.02 < grain.std() / 255 < 0.06


def test_the_start_is_where_it_was_put():
    env = make(observation="features",
               randomise={"sideways": (0.1, 0.1), "along": (0.5, 0.5), "turn": (0.2, 0.2)})
    _, info = env.reset(seed=0)
    sample, track = env.unwrapped._simulation.sample(), env.unwrapped._task._drive.track
    env.close()
    assert info["lateral_m"] == pytest.approx(0.1, abs=0.005)
    assert track.nearest(sample.x, sample.y).s == pytest.approx(0.5, abs=0.01)
    assert sample.yaw == pytest.approx(track.pose(0.5)[2] + 0.2, abs=0.01)


def test_friction_decides_how_soon_it_is_off():
    def way(friction):
        env = make(observation="features", size=(32, 18), randomise={"friction": (friction,) * 2})
        env.reset(seed=0)
        for _ in range(15):
            info = env.step(np.array([0.4, 0.0], np.float32))[4]
        env.close()
        return info["progress_m"]

    assert way(0.02) < 0.8 * way(1.0)


def test_random_tracks_differ_and_are_driven_from_their_line():
    env = make(size=(64, 48), randomise={"tracks": (1, 2)})
    found = {}
    for seed in range(6):
        picture, info = env.reset(seed=seed)
        assert abs(info["lateral_m"]) < 0.01
        found[picture.tobytes()] = env.unwrapped._task._drive.track.length
    env.close()
    assert len(found) == 2
    assert len(set(found.values())) == 2


@pytest.mark.parametrize(("options", "said"), [
    ({"observation": "film"}, "observation: must be one of"),
    ({"action": "thrust"}, "action: must be one of"),
    ({"laps": 0}, "laps: must be a whole number"),
    ({"duration": 0.0}, "duration: must be"),
    ({"timestep": 0.1}, "timestep: must be"),
    ({"size": (0, 5)}, "size: must be a whole number"),
    ({"randomise": {"fog": (0, 1)}}, "unknown key 'fog'"),
    ({"randomise": {"light": (1.3, 0.7)}}, "light: must be"),
    ({"randomise": {"tracks": 5}}, "tracks: must be whole numbers"),
])
def test_a_mistake_is_one_line(options, said):
    with pytest.raises(CourseError, match=said):
        make(**options)


def test_options_have_no_effect_on_how_many_numbers_are_drawn():
    wide = dataclasses.asdict(TRIALS)
    one, other = make(randomise=wide, size=(8, 8)), make(size=(8, 8))
    for env in (one, other):
        env.reset(seed=4)
    assert one.unwrapped.np_random.random() == other.unwrapped.np_random.random()
    one.close()
    other.close()


def test_nothing_of_ros_is_imported():
    code = ("import sys, gymnasium, driving_courses; "
            f"gymnasium.make('{LINE}', size=(8, 8)).reset(seed=0); "
            "print([m for m in sys.modules if m.split('.')[0] in "
            "('rospy', 'rospkg', 'roslib', 'rosgraph', 'genpy', 'cv_bridge')])")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "[]", done.stderr
