"""A gripper's goal: reached, stalled, held; by position and by effort."""

import pytest

from bullet_sim.control.controllers.gripper import (
    Gripper,
    GripperOptions,
    move_by_effort,
    move_by_position,
)
from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.pid import Pid, PidGains

STEP = 0.001  # s


class Jaw:
    """A joint that closes at 0.1 m/s towards its command, up to an obstacle."""

    def __init__(self, obstacle: float = 1.0):
        self.handle = CommandHandle(JointHandle("jaw", "prismatic"), "position")
        self.gripper = Gripper(self.handle, move_by_position(self.handle),
                               GripperOptions(goal_tolerance=0.002, stall_timeout=0.5))
        self.obstacle = obstacle
        self.time = 0.0
        self.gripper.start(0.0)

    def run(self, seconds: float):
        joint = self.handle.joint
        for _ in range(round(seconds / STEP)):
            self.time += STEP
            outcome = self.gripper.update(self.time, STEP)
            gap = min(self.handle.command, self.obstacle) - joint.position
            move = max(-0.1 * STEP, min(0.1 * STEP, gap))
            joint.position, joint.velocity = joint.position + move, move / STEP
            if outcome:
                return outcome
        return None


def test_a_goal_is_reached():
    jaw = Jaw()
    assert jaw.gripper.state().effort == 0.0  # nothing has been done yet
    jaw.gripper.pursue(0.0, 0.05, 10.0)
    assert jaw.run(0.45) is None
    outcome = jaw.run(0.1)
    assert (outcome.reached_goal, outcome.stalled) == (True, False)
    assert outcome.position == pytest.approx(0.05, abs=0.002)
    assert jaw.run(2.0) is None


def test_an_obstacle_is_a_stall_after_its_time():
    jaw = Jaw(obstacle=0.02)
    jaw.gripper.pursue(0.0, 0.05, 10.0)
    assert jaw.run(0.65) is None
    outcome = jaw.run(0.2)
    assert (outcome.reached_goal, outcome.stalled, outcome.effort) == (False, True, 10.0)
    assert jaw.handle.command == 0.05  # it goes on pressing


def test_hold_stays_here():
    jaw = Jaw()
    jaw.gripper.pursue(0.0, 0.05, 10.0)
    jaw.run(0.2)
    jaw.gripper.hold()
    assert jaw.run(2.0) is None
    assert jaw.handle.joint.position == pytest.approx(0.02, abs=0.001)


def test_effort_is_a_pid_within_the_goals_bound():
    handle = CommandHandle(JointHandle("jaw", "prismatic"), "effort")
    move = move_by_effort(handle, Pid(PidGains(p=100.0, d=1.0)))
    handle.joint.velocity = 0.5
    assert move(0.02, 10.0, STEP) == pytest.approx(100 * 0.02 - 0.5)
    assert move(1.0, -3.0, STEP) == 3.0
    assert handle.command == 3.0
