"""Points that take long, or fail: what waits for them, and whose they are."""

import time

import pytest
from camera_models import eye

from bullet_sim_ros import convert, loop

KINECT = "libgazebo_ros_openni_kinect.so"
LATE = 0.2  # s, wall
PICTURE = 100  # steps until the first one


def spawn(bench, name):
    bench.spawn(eye(KINECT, kind="depth").replace("<cameraName>eye", f"<cameraName>{name}"),
                name=name)
    return bench.listen(f"/{name}/points")


@pytest.fixture
def slow(monkeypatch):
    """Points that come later than any step."""
    made = convert.points_to_msg

    def points_to_msg(*arguments):
        time.sleep(LATE)
        return made(*arguments)

    monkeypatch.setattr(convert, "points_to_msg", points_to_msg)


def test_the_last_points_of_a_camera_come_before_it_is_gone(bench, slow):
    # conforms: libgazebo_ros_openni_kinect.so
    messages = spawn(bench, "eye")
    loop.run(bench.simulation, PICTURE)
    bench.delete("eye")
    assert len(messages) == 1


def test_in_lockstep_points_have_come_when_their_picture_has(make_bench, slow):
    # conforms: libgazebo_ros_openni_kinect.so
    bench = make_bench(lockstep="/cmd_vel", lockstep_timeout=1e-3)
    messages = spawn(bench, "eye")
    loop.run(bench.simulation, PICTURE)
    assert len(messages) == 1


def test_a_camera_whose_points_fail_is_switched_off_alone(bench, monkeypatch):
    # conforms: libgazebo_ros_openni_kinect.so
    """It hears of it at its next picture, whose points are on their way then."""
    made, failures = convert.points_to_msg, [MemoryError("no room for points")]

    def points_to_msg(*arguments):
        if failures:
            raise failures.pop()
        return made(*arguments)

    monkeypatch.setattr(convert, "points_to_msg", points_to_msg)
    first, second = spawn(bench, "first"), spawn(bench, "second")
    for _ in range(5):
        bench.run_steps(PICTURE)
    assert (len(first), len(second)) == (1, 5)
