"""Planners that are replaced by dynamic_reconfigure while they are at work; no master."""

import numpy as np
import pytest
import rospy

from move_base import plugin
from move_base.global_planners import GOAL_OFF, START_OFF, Navfn
from move_base.local_planners import Dwa, Situation
from nav_algorithms.costmap.costs import Costmap


class Topic:
    """As rospy's publisher: what is asked of it after `unregister` fails."""

    def __init__(self, *_arguments, **_settings):
        self.impl, self.sent = [], []

    def get_num_connections(self):
        self.impl.append("asked")
        return 1

    def publish(self, message):
        self.sent.append(message)

    def unregister(self):
        self.impl = None


@pytest.fixture(autouse=True)
def no_master(monkeypatch):
    monkeypatch.setattr(rospy, "Publisher", Topic)
    monkeypatch.setattr(rospy, "has_param", lambda _name: False)
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(1))
    monkeypatch.setattr(plugin, "read_parameters",
                        lambda entries, _: {entry.name: entry.default for entry in entries})
    monkeypatch.setattr(plugin, "serve_changes", lambda *_: None)


COSTMAP = Costmap(np.zeros((40, 40), np.uint8), 0.1, (0.0, 0.0))
START, GOAL = np.array([1.0, 1.0, 0.0]), np.array([3.0, 3.0, 0.0])


@pytest.mark.parametrize(("start", "goal", "said"), [
    (START, GOAL, []), (START, np.array([9.0, 1.0, 0.0]), [GOAL_OFF]),
    (np.array([-1.0, 1.0, 0.0]), GOAL, [START_OFF])])
def test_a_start_or_goal_off_the_costmap_is_said(monkeypatch, start, goal, said):
    told = []
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda _period, why: told.append(why))
    planner = Navfn(None)
    path = planner.plan(COSTMAP, None, start, goal, "map")
    assert (path is None) is bool(said) and told == said


@pytest.mark.parametrize("replaced", [False, True])
def test_a_path_of_a_planner_that_was_replaced_counts_and_is_not_published(replaced):
    planner = Navfn(None)
    topic, plan = planner._topic, planner._plan
    planner._plan = lambda *arguments: (planner.close() if replaced else None, plan(*arguments))[1]
    assert planner.plan(COSTMAP, None, START, GOAL, "map")[-1] == pytest.approx(GOAL)
    assert len(topic.sent) == (0 if replaced else 1)


@pytest.mark.parametrize("replaced", [False, True])
def test_a_command_of_a_planner_that_was_replaced_counts_and_is_not_published(replaced):
    planner = Dwa(10.0, None)
    planner.set_path(np.linspace(START, GOAL, 30), False)
    topic, command = planner._local_plan, planner._planner.command
    planner._planner.command = lambda *arguments: (
        planner.close() if replaced else None, command(*arguments))[1]
    outline = np.array([[-0.1, -0.1], [-0.1, 0.1], [0.1, 0.1], [0.1, -0.1]])
    found = planner.command(Situation(COSTMAP, "map", outline, START, np.zeros(3), np.zeros(3)))
    assert found is not None and len(topic.sent) == (0 if replaced else 1)
