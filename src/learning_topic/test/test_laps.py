"""A lap of lessons 5 and 6 on a drawn course: seconds, no simulator, known distances."""

import numpy as np
import pytest
import rospy
from drawn_course import Course, drive


@pytest.fixture(scope="module")
def course():
    return Course()


def lesson_6(module):
    """Lesson 6 without its node: see and follow as its callback does."""
    follower = object.__new__(module.Follower)
    follower.config = module.load_config(module.CONFIG, {})
    follower.side, follower.stamp = 1.0, 0.0
    follower.stand()

    def follow(image, time):
        follower.follow(module.see_line(image, follower.config), time)
        return follower.command.linear.x, follower.command.angular.z

    return follow


def rms(distances):
    return float(np.sqrt(np.mean(distances**2)))


def test_lesson_5_closes_a_lap_as_the_tutorial_has_it(lesson, course):
    five = lesson(5)

    def follow(image, _time):
        centre = five.find_line(image)
        return (five.SPEED, five.steer(centre[0] - 960)) if centre else (0.0, 0.0)

    assert 0.03 < rms(drive(course, follow)) < 0.06


@pytest.mark.parametrize("beside", [0.0, 0.05])
def test_lesson_6_stays_on_the_line(lesson, course, beside):
    distances = drive(course, lesson_6(lesson(6)), beside=beside)
    assert rms(distances[90:]) < 0.01  # after 3 s, the way back to the line
    assert np.abs(distances[90:]).max() < 0.02


def test_lesson_6_finds_a_line_it_lost(lesson, course, monkeypatch):
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda *_: None)  # needs a node
    follow, blind = lesson_6(lesson(6)), range(200, 215)
    commands = []

    def sometimes_blind(image, time):
        frame = round(time * 30)
        commands.append(follow(image * 0 if frame in blind else image, time))
        return commands[-1]

    drive(course, sometimes_blind)
    lost = commands[blind.start : blind.stop]
    assert all(speed == 0 and abs(turn) == 0.5 for speed, turn in lost)
    assert commands[blind.stop][0] == 0.2
