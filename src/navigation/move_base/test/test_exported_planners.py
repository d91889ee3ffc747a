"""Planners of other packages, found by package.xml as pluginlib finds C++ ones; no master."""

from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from rospkg import RosPack

from move_base import exported_planners, plugin
from move_base.exported_planners import GLOBAL, exported, global_planner, local_planner
from move_base.local_planners import Situation
from nav_algorithms.costmap.costs import Costmap
from nav_nodes.parameters import ParameterError

MANIFEST = """<package format="2"><name>{0}</name><version>0.1.0</version>
<description>d</description><maintainer email="a@example.org">a</maintainer><license>MIT</license>
<export><nav_core plugin="${{prefix}}/planner_plugin.xml"/></export></package>"""
PLUGINS = """<library path="src">
  <class name="{0}/Straight" type="{0}_planners.Straight"
         base_class_type="nav_core::BaseGlobalPlanner"/>
  <class name="{0}/InCpp" type="{0}::InCpp" base_class_type="nav_core::BaseGlobalPlanner"/>
  <class name="{0}/Missing" type="{0}_planners.Missing"
         base_class_type="nav_core::BaseGlobalPlanner"/>
  <class name="{0}/Half" type="{0}_planners.Half" base_class_type="nav_core::BaseLocalPlanner"/>
  <class name="{0}/Creep" type="{0}_planners.Creep" base_class_type="nav_core::BaseLocalPlanner"/>
</library>"""
CODE = """
from geometry_msgs.msg import Twist

class Straight:
    def initialize(self, name, costmap):
        self.name, self.costmap = name, costmap

    def make_plan(self, start, goal):
        return [start, goal] if goal.pose.position.x < 5.0 else []

class Half:
    def initialize(self, name, tf, costmap): ...

class Creep:
    def initialize(self, name, tf, costmap):
        self.plan = None

    def set_plan(self, plan):
        self.plan = plan
        return len(plan) > 1

    def compute_velocity_commands(self):
        if len(self.plan) == 3:
            raise ZeroDivisionError("a learner's fault")
        command = Twist()
        command.linear.x = 0.1
        return command

    def is_goal_reached(self):
        return False
"""
COSTMAP = Costmap(np.zeros((40, 40), np.uint8), 0.1, (0.0, 0.0))
START, GOAL = np.array([1.0, 1.0, 0.0]), np.array([3.0, 3.0, 0.5])


class Topic:
    """As rospy's publisher, with somebody who listens."""

    def __init__(self, name, *_arguments, **_settings):
        self.name, self.sent = name, []

    def get_num_connections(self):
        return 1

    def publish(self, message):
        self.sent.append(message)

    def unregister(self): ...


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Its name, which no other test's has: Python imports a module once."""
    folder = tmp_path / f"learner_{tmp_path.name}"
    (folder / "src").mkdir(parents=True)
    (folder / "package.xml").write_text(MANIFEST.format(folder.name))
    (folder / "planner_plugin.xml").write_text(PLUGINS.format(folder.name))
    (folder / "src" / f"{folder.name}_planners.py").write_text(CODE)
    packages = RosPack([str(tmp_path)])
    monkeypatch.setattr(exported_planners.rospkg, "RosPack", lambda: packages)
    monkeypatch.setattr(exported_planners.sys, "path", [*exported_planners.sys.path])
    monkeypatch.setattr(rospy, "Publisher", Topic)
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(1))
    monkeypatch.setattr(plugin, "read_parameters",
                        lambda entries, _: {entry.name: entry.default for entry in entries})
    return folder


def test_a_class_of_a_package_plans(package):
    kind = global_planner(f"{package.name}/Straight", "~base_global_planner")
    assert kind is global_planner(f"{package.name}/Straight", "x") and kind.NAME == "Straight"
    planner = kind(SimpleNamespace(global_frame="map"))
    path = planner.plan(COSTMAP, None, START, GOAL, "map")
    assert path == pytest.approx(np.stack((START, GOAL)))
    assert planner._topic.name == "~Straight/plan" and len(planner._topic.sent[0].poses) == 2
    assert planner.plan(COSTMAP, None, START, GOAL + 5.0, "map") is None


def test_a_class_of_a_package_drives_and_its_fault_is_no_velocity(package, monkeypatch):
    lines = []
    monkeypatch.setattr(rospy, "logerr_throttle", lambda _period, text: lines.append(text))
    costmap = SimpleNamespace(global_frame="map", transforms=SimpleNamespace(buffer=None))
    planner = local_planner(f"{package.name}/Creep", "x")(10.0, (costmap, costmap))
    situation = Situation(COSTMAP, "map", None, START, np.zeros(3), np.zeros(3))
    planner.set_path(np.stack((START, GOAL)), False)
    assert planner.command(situation).velocity.tolist() == [0.1, 0.0, 0.0]
    assert not planner.reached(situation) and planner.values["odom_topic"] == "odom"
    planner.set_path(np.stack((START, START, GOAL)), False)
    assert planner.command(situation) is None and "a learner's fault" in lines[0]
    with pytest.raises(ValueError, match="Creep"):
        planner.set_path(START[None], False)


@pytest.mark.parametrize("name, words", [
    ("nothing/There", "Straight.*navfn/NavfnROS"), ("{0}/InCpp", "there are only"),
    ("{0}/Missing", "planner_plugin.xml.*Missing.*AttributeError")])
def test_what_cannot_be_loaded_is_one_line(package, name, words):
    with pytest.raises(ParameterError, match=words) as error:
        global_planner(name.format(package.name), "~base_global_planner")
    assert "\n" not in str(error.value)


def test_a_local_planner_without_its_methods_is_refused(package):
    with pytest.raises(ParameterError, match=r"no set_plan.*compute_velocity_commands"):
        local_planner(f"{package.name}/Half", "x")


def test_a_broken_file_is_named(package):
    (package / "planner_plugin.xml").write_text("<library")
    with pytest.raises(ParameterError, match=r"planner_plugin.xml.*must hold"):
        global_planner("nothing/There", "x")


def test_a_package_that_nobody_can_read_is_passed_over(package):
    manifest = package / "package.xml"
    manifest.write_text(manifest.read_text().replace("a@example.org", "nobody"))
    assert exported(GLOBAL) == {}


def test_ours_are_found_without_looking_at_packages(monkeypatch):
    monkeypatch.setattr(exported_planners, "exported", lambda _base: pytest.fail("looked"))
    for name in ("navfn/NavfnROS", "global_planner/GlobalPlanner", "NavfnROS"):
        assert name.rpartition("/")[2] == global_planner(name, "x").NAME
    for name in ("base_local_planner/TrajectoryPlannerROS", "dwa_local_planner/DWAPlannerROS"):
        assert name.rpartition("/")[2] == local_planner(name, "x").NAME
