"""Drives without a simulator: what is seen, and how a drive ends."""

import queue
from types import SimpleNamespace

import numpy as np
import pytest

from evaluation import yard_drive as driving
from evaluation.navigation_trials import judged
from evaluation.trial import Case
from evaluation.yard_drive import (
    BY_PERSON,
    BY_ROBOT,
    CROSSINGS,
    OBSTACLE,
    SLOW,
    YARDS,
    Passage,
    Sample,
)
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.processes import Family
from trial_worlds.crossing import draw_crossing
from trial_worlds.yard import RADIUS

CROSSING = Case("a person", CROSSINGS, 4)
NOBODY = np.empty((0, 2))


def at(time, x, speed=0.26, person=None) -> Sample:
    return Sample(time, (x, 0.0, 0.0), speed, person)


# --- what is seen


def test_time_and_way_are_counted_from_the_first_sample():
    seen = Passage(np.array([[1.0, 0.253 + RADIUS]]))
    for n in range(5):
        seen.see(at(10.0 + n, 0.25 * n))
    assert (seen.time, seen.distance, seen.contact, len(seen.path)) == (4.0, 1.0, None, 5)
    assert seen.to_obstacles == pytest.approx(0.1)


def test_a_contact_ends_what_counts():
    seen = Passage(np.array([[0.9 + RADIUS, 0.0]]))
    for n in range(100):
        seen.see(at(0.1 * n, 0.026 * n))
    assert seen.contact == OBSTACLE
    assert seen.time == pytest.approx(3.2)  # 0.827 m until the camera touches


@pytest.mark.parametrize(("speed", "said"), [(0.1, BY_ROBOT), (0.0, BY_PERSON)])
def test_who_touched_whom(speed, said):
    seen = Passage(NOBODY)
    seen.see(at(0.0, 0.0, speed, (0.5, 0.0, 0.0)))
    assert seen.contact is None and seen.to_person == pytest.approx(0.177)
    seen.see(at(0.1, 0.0, speed, (0.31, 0.0, 0.0)))
    assert seen.contact == said


# --- one drive


class FakeRig:
    """Drives straight on to the goal at 0.26 m/s, or until it is told to end."""

    def __init__(self, limit=1000, person=False):
        self.limit, self.there, self.walks, self.recoveries = limit, person, [], []
        self.slow_cycles = 0

    def prepare(self, _models, start):
        self.start = start

    def send(self, _goal):
        self.now = 0.0

    def result(self):
        return "reached" if self.now >= self.limit else None

    def samples(self, _wait):
        self.now += 0.1
        person = (9.0, 9.0, 0.0) if self.there else None
        return [at(self.now, self.start[0] + 0.26 * self.now, person=person)]

    def wait(self, condition, _what):
        assert condition()

    def person_listens(self):
        return True

    def walk(self, speed):
        self.walks.append(round(0.26 * self.now, 3) if speed else 0.0)

    def end_goal(self):
        pass


def drive(rig, task):
    """The result, and where it went."""
    record = driving.drive_task(rig, task)
    return judged(record), record.passage.path


def test_a_drive_into_an_obstacle_is_a_contact():
    found, way = drive(FakeRig(), driving.task_of(Case("a", YARDS, 3)))
    assert (found.outcome, found.why) == ("contact", OBSTACLE) and len(way) > 3


def test_the_person_sets_off_when_the_robot_has_come_so_far():
    rig, walk = FakeRig(limit=19.0, person=True), draw_crossing(4)
    found, _ = drive(rig, driving.task_of(CROSSING))
    assert found.outcome == "reached" and found.straight_time == pytest.approx(5 / 0.26, abs=0.01)
    first, *_, last = rig.walks
    assert walk.trigger <= first < walk.trigger + 0.03 and last == 0.0


def test_a_drive_that_takes_too_long_is_late():
    found, _ = drive(FakeRig(person=True), driving.task_of(CROSSING))
    assert found.outcome == "late" and found.time == pytest.approx(driving.LIMIT, abs=0.2)


def test_a_goal_that_was_called_reached_from_afar_was_not():
    found, _ = drive(FakeRig(limit=15.0, person=True), driving.task_of(CROSSING))
    assert found.outcome == "called reached" and found.why.startswith("from 1.")


def test_samples_that_stop_are_noticed_though_the_clock_goes_on():
    seen = []
    stack = object.__new__(driving.NavigationStack)  # without ROS
    stack._samples, stack._newest = queue.SimpleQueue(), 0.0
    stack._launched = SimpleNamespace(check_time=lambda now, limit: seen.append((now, limit)))
    stack._samples.put(at(1.0, 0.0))
    stack._samples.put(at(1.1, 0.0))
    assert len(stack.samples()) == 2 and stack.samples() == []
    assert seen == [(1.1, driving.SILENCE)] * 2


def test_what_roslaunch_says_of_the_nodes(tmp_path):
    slow = "[ WARN] Control loop missed its desired rate of 10.0000Hz... took 0.2 seconds"
    died = "[move_base-4] process has died [pid 7, exit code -9, cmd x]"
    with Family() as family:
        launched = Launched(family, tmp_path / "log", vehicle="robot")
        child = launched.start("yard", ["sleep", "60"])
        child.log.write_text(f"{slow}\nall is well\n{slow}\n")
        launched.check(1.0)
        assert launched.count_said(SLOW) == 2
        child.log.write_text(f"{slow}\nall is well\n{slow}\n{died}\n")
        with pytest.raises(RunError, match="process move_base-4 died"):
            launched.check(2.0)
