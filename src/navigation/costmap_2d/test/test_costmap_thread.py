"""The thread that keeps a costmap up to date goes on, whatever happens to it; no master."""

from types import SimpleNamespace

import pytest
import rospy

from costmap_2d import costmap_ros
from costmap_2d.costmap_ros import CostmapROS


@pytest.fixture
def costmap(monkeypatch):
    """One whose updates are the test's own; `events` has what came of them."""
    found = CostmapROS.__new__(CostmapROS)
    found.name, found.events, found.now = "costmap", [], 100.0
    found._values = {"update_frequency": 5.0, "publish_frequency": 0.0}
    found._paused = found._stopped = False
    found.transforms = SimpleNamespace(
        buffer=SimpleNamespace(clear=lambda: found.events.append("no transforms")))
    found._sensors = SimpleNamespace(forget=lambda: found.events.append("no sensors"))
    found._publish_if_due = lambda: None
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time.from_sec(found.now))
    monkeypatch.setattr(rospy, "sleep", lambda period: found.events.append(f"{period:.1f} s"))
    monkeypatch.setattr(costmap_ros.time, "sleep", lambda _period: None)
    monkeypatch.setattr(rospy, "logerr_throttle", lambda _period, text: found.events.append(text))
    monkeypatch.setattr(rospy, "is_shutdown", lambda: len(found.updates) == 0)
    found.update = lambda: found.updates.pop(0)()
    return found


def test_a_clock_that_goes_back_during_an_update_is_no_reason_to_sleep(costmap):
    """It slept as long as the simulation had run before."""
    costmap.updates = [lambda: setattr(costmap, "now", 1.0), lambda: True]
    costmap._keep_updating()
    assert costmap.events == ["no transforms", "no sensors", "0.2 s"]


def test_an_update_that_fails_is_said_and_the_next_one_comes(costmap):
    """Without updates the robot stands."""
    costmap.updates = [lambda: 1 / 0, lambda: True]
    costmap._keep_updating()
    failure, rest = costmap.events
    assert "costmap: an update failed" in failure and "ZeroDivisionError" in failure
    assert rest == "0.2 s"
