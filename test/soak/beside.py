"""User activity during a course: page views, spawning and deleting, goals, a rosbag."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import rospy
from geometry_msgs.msg import PoseStamped

from run_session.launch import Launched
from run_session.simulator import delete, spawn_urdf

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "src/sim/sim_viewer/test"))
from page_link import PageLink

VISITORS = 5
SPAWN_PERIOD = 10.0  # s, wall, for which a model is present or absent
BAG = ["rosbag", "record", "--all", "--split", "--duration=60", "--max-splits=3",
       "--exclude=.*(image|points).*"]
MODEL, PLACE = "visitor", (50.0, 50.0)  # m, an empty place
GOALS, GOAL_PERIODS = ((1.5, -1.5), (-1.4, 1.4)), 6  # m in map, in turn, every so many spawns
BOX = """<robot name="visitor"><link name="box">
  <inertial>
    <mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>
  </inertial>
  <visual><geometry><box size="0.3 0.3 0.3"/></geometry></visual>
  <collision><geometry><box size="0.3 0.3 0.3"/></geometry></collision>
</link></robot>"""


class Beside:
    """Starts immediately; call `act` repeatedly."""

    def __init__(self, launched: Launched, folder: Path):
        launched.start("bag", [*BAG, "-o", str(folder / "rolling")])
        launched.start("page", ["roslaunch", "sim_viewer", "viewer.launch"])
        rospy.init_node("soak", anonymous=True, disable_signals=True)
        url = launched.wait_for(
            "the page", lambda: rospy.get_param("/sim_viewer/url", ""), 120.0)
        camera = next(topic for topic, kind in rospy.get_published_topics()
                      if kind == "sensor_msgs/Image")
        self._visitors = [PageLink(url) for _ in range(VISITORS)]
        for each in self._visitors:
            each.ask("watch", what="image", args={"topic": camera})
            each.ask("watch", what="poses")
        self._goals = rospy.Publisher("/move_base_simple/goal", PoseStamped, queue_size=1)
        self._count, self._due = 0, time.monotonic()

    def act(self) -> None:
        """Discard what the visitors received; spawn, delete and send a goal when due."""
        time.sleep(0.2)
        for each in self._visitors:
            each.events.clear()
        if time.monotonic() < self._due:
            return
        self._due = time.monotonic() + SPAWN_PERIOD
        if self._count % 2:
            delete(MODEL)
        else:
            spawn_urdf(MODEL, BOX, "", *PLACE)
        if self._count % GOAL_PERIODS == 1:  # not at once: move_base may be starting
            goal = PoseStamped()
            goal.header.frame_id, goal.pose.orientation.w = "map", 1.0
            place = GOALS[self._count // GOAL_PERIODS % len(GOALS)]
            goal.pose.position.x, goal.pose.position.y = place
            self._goals.publish(goal)
        self._count += 1

    def end(self) -> None:
        """Disconnect the visitors."""
        for each in self._visitors:
            each.close()
