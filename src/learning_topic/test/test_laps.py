"""A lap of lessons 5, 6 and 7 on a drawn course: seconds, no simulator, known distances."""

import numpy as np
import pytest
import rospy
from drawn_course import DrawnCourse, drive


@pytest.fixture(scope="module")
def course():
    return DrawnCourse()


def lesson_6(module):
    """Lesson 6 without its node: find and steer as its callback does."""
    follower = object.__new__(module.Follower)
    follower.kp, follower.ki, follower.kd = module.KP, module.KI, module.KD
    follower.reset()

    def follow(image, time):
        centre = module.find_line(image)
        return (module.SPEED, follower.steer(centre[0] - 960, time)) if centre else (0.0, 0.0)

    return follow


def lesson_7(module):
    """Lesson 7 without its node: see and drive as its callback does."""
    follower = object.__new__(module.Follower)
    follower.speed, follower.camera, follower.side = module.SPEED, module.CAMERA, 1.0

    def follow(image, _time):
        command = follower.command(module.see_line(image, follower.camera))
        return command.linear.x, command.angular.z

    return follow


def rms(distances):
    return float(np.sqrt(np.mean(distances**2)))


def test_lesson_5_closes_a_lap_as_the_tutorial_has_it(lesson, course):
    five = lesson(5)

    def follow(image, _time):
        centre = five.find_line(image)
        return (five.SPEED, five.steer(centre[0] - 960)) if centre else (0.0, 0.0)

    assert 0.03 < rms(drive(course, follow)) < 0.06


def test_lesson_6_keeps_the_line_nearer_the_middle_than_p_alone(lesson, course, monkeypatch):
    six, seen = lesson(6), []
    find_line = six.find_line
    monkeypatch.setattr(six, "find_line", lambda image: seen.append(find_line(image)) or seen[-1])
    far_off = []
    for gains in ((six.KP, six.KI, six.KD), (1 / 1000, 0.0, 0.0)):
        for name, gain in zip(("KP", "KI", "KD"), gains):
            monkeypatch.setattr(six, name, gain)
        seen.clear()
        assert rms(drive(course, lesson_6(six))) < 0.06  # its camera is not in the robot's middle
        far_off.append(rms(np.array([column for column, _row in seen[90:]]) - 960))
    assert far_off[0] < 70 < 150 < far_off[1]


@pytest.mark.parametrize("beside", [0.0, 0.05])
def test_lesson_7_stays_on_the_line(lesson, course, beside):
    distances = drive(course, lesson_7(lesson(7)), beside=beside)
    assert rms(distances[90:]) < 0.01  # after 3 s, the way back to the line
    assert np.abs(distances[90:]).max() < 0.02


def test_lesson_7_finds_a_line_it_lost(lesson, course, monkeypatch):
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda *_: None)  # needs a node
    follow, blind = lesson_7(lesson(7)), range(200, 215)
    commands = []

    def sometimes_blind(image, time):
        frame = round(time * 30)
        commands.append(follow(image * 0 if frame in blind else image, time))
        return commands[-1]

    drive(course, sometimes_blind)
    lost = commands[blind.start : blind.stop]
    assert all(speed == 0 and abs(turn) == 0.5 for speed, turn in lost)
    assert commands[blind.stop][0] == 0.2
