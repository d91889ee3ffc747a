"""Messages to the subscribers of nodes, in one process and without a master."""

from __future__ import annotations

import importlib
import itertools
import random
import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import rospkg
import rospy
from hypothesis import strategies as st
from messages import carried, spoil
from nav_msgs.msg import OccupancyGrid
from target import ROOT, Target
from tf2_msgs.msg import TFMessage

from bullet_sim_ros.without_master import Graph, without_master
from nav_nodes.messages import transform_message
from nav_nodes.parameters import load_table, read_parameters

FRAMES = ("map", "odom", "base_footprint", "base_link", "base_scan")
NAMES = (*FRAMES, "left_rear_wheel_joint", "right_rear_wheel_joint", "left_steering_hinge_joint",
         "right_steering_hinge_joint", "rgb8", "bgr8", "mono8", "16UC1", "32FC1", "x", "y", "z")
MESSAGES = 6
LISTENED = ("scan", "cloud", "/lane_keeping/annotated", "~annotated", "~picture")
SOURCES = [{"name": name, "topic": name, "timeout": 0.5, "priority": 1} for name in "ab"]
FUSED = {f"{kind}0{ending}": value for kind in ("odom", "imu", "pose", "twist")
         for ending, value in (("", kind), ("_config", [True] * 15), ("_differential", True))}
FUSED |= {"pose1": "first_pose", "pose1_config": [True] * 15, "pose1_relative": True}
COMPAT, CAR, LESSONS = "compat", "car_control/scripts", "lessons"


def of_script(path: str, kind: str = "main", **parameters: Any) -> Callable[[], Any]:
    """Calls the class of a node, or a main that only waits once it has subscribed."""
    def make() -> Any:
        set_params(parameters)
        return runpy.run_path(str(ROOT / "src" / path))[kind]()
    return make


def of_settings(path: str, kind: str, settings: str, *words: Any) -> Callable[[], Any]:
    """Calls the class of a node with the settings that its main reads."""
    def make() -> Any:
        script = runpy.run_path(str(ROOT / "src" / path))
        return script[kind](script["read_settings"](script[settings], *words))
    return make


def of_table(package: str, kind: str, file: str, **parameters: Any) -> Callable[[], Any]:
    """Calls the class of a navigation's node with the defaults of its table."""
    def make() -> Any:
        set_params(parameters)
        module = importlib.import_module(f"{package}.node")
        for name in {"SCAN_PATIENCE", "PATIENCE"} & set(vars(module)):
            setattr(module, name, 0.01)  # s that a scan waits for its odometry
        table = load_table(Path(rospkg.RosPack().get_path(package)) / "params" / file)
        return getattr(module, kind)(read_parameters(table),
                                     *([table] if package == "amcl" else []))
    return make


def of_class(module: str, kind: str, **parameters: Any) -> Callable[[], Any]:
    """Calls the class of a module."""
    def make() -> Any:
        set_params(parameters)
        return getattr(importlib.import_module(module), kind)()
    return make


def set_params(values: dict[str, Any]) -> None:
    """The node's own."""
    for name, value in values.items():
        rospy.set_param(f"~{name}", value)


LASER_FILTERS = {
    "LaserScanRangeFilter": {"lower_threshold": 0.3}, "LaserScanIntensityFilter": {},
    "LaserScanFootprintFilter": {"inscribed_radius": 0.3}, "InterpolationFilter": {},
    "ScanShadowsFilter": {"min_angle": 10.0, "max_angle": 170.0, "window": 2, "neighbors": 1},
    "LaserScanSpeckleFilter": {}, "LaserScanMaskFilter": {"masks": {"laser": [0, 3]}},
    "LaserScanAngularBoundsFilter": {"lower_angle": -1.0, "upper_angle": 1.0},
    "LaserArrayFilter": {"range_filter_chain": [{"type": "MultiChannelMedianFilterFloat",
                                                 "params": {"number_of_observations": 3}}]}}
NODES: dict[str, Callable[[], Any]] = {
    "twist_mux": of_script(f"{COMPAT}/twist_mux/nodes/twist_mux", topics=SOURCES,
                           locks=[{**SOURCES[0], "topic": "lock"}]),
    "teleop_twist_joy": of_script(f"{COMPAT}/teleop_twist_joy/nodes/teleop_node"),
    "depthimage_to_laserscan": of_script(
        f"{COMPAT}/depthimage_to_laserscan/nodes/depthimage_to_laserscan", "DepthToLaser"),
    "pointcloud_to_laserscan": of_script(
        f"{COMPAT}/pointcloud_to_laserscan/nodes/pointcloud_to_laserscan_node", "CloudToLaser",
        target_frame="base_link"),
    "laserscan_to_pointcloud": of_script(
        f"{COMPAT}/pointcloud_to_laserscan/nodes/laserscan_to_pointcloud_node", "LaserToCloud",
        target_frame="base_link"),
    "laser_filters": of_script(
        f"{COMPAT}/laser_filters/nodes/scan_to_scan_filter_chain", "FilterChain",
        scan_filter_chain=[{"type": f"laser_filters/{kind}", "params": params}
                           for kind, params in LASER_FILTERS.items()]),
    "robot_pose_ekf": of_script(f"{COMPAT}/robot_pose_ekf/nodes/robot_pose_ekf", "RobotPoseEkf"),
    "imu_complementary_filter": of_script(
        f"{COMPAT}/imu_complementary_filter/nodes/complementary_filter_node",
        "ComplementaryFilter"),
    "turtlebot3_fake": of_script(f"{COMPAT}/turtlebot3_fake/nodes/turtlebot3_fake_node", "Fake"),
    "turtlebot3_drive": of_script(f"{COMPAT}/turtlebot3_gazebo/nodes/turtlebot3_drive",
                                  "Turtlebot3Drive"),
    "robot_localization": of_class("robot_localization.node", "LocalizationNode", **FUSED),
    "motor_control": of_settings(f"{CAR}/motor_control.py", "MotorControl", "MotorSettings",
                                 "car_control.yaml", "motor_control"),
    "wheel_odometry": of_settings(f"{CAR}/wheel_odometry.py", "WheelOdometry", "MotorSettings",
                                  "car_control.yaml", "motor_control"),
    "lane_follow": of_settings(f"{CAR}/lane_follow.py", "LaneFollow", "LaneSettings",
                               "lane_follow.yaml"),
    "amcl": of_table("amcl", "AmclNode", "amcl.yaml", min_particles=10, max_particles=50,
                     use_map_topic=True),
    "slam_gmapping": of_table("gmapping", "SlamNode", "slam_gmapping.yaml", particles=2, xmin=-5.0,
                              ymin=-5.0, xmax=5.0, ymax=5.0),
    "hector_mapping": of_table("hector_mapping", "HectorMapping", "hector_mapping.yaml",
                               map_size=100),
    "fake_localization": of_table("fake_localization", "FakeLocalization",
                                  "fake_localization.yaml"),
    "tracker": of_settings(f"{LESSONS}/ai_robot_tracking/scripts/visual_tracker_pid.py",
                           "VisualTrackerPid", "FollowerSettings", "visual_tracker_pid"),
}


def use_node(path: Path) -> None:
    """A node and some messages by the file's seed, in what order they like."""
    rng = random.Random(path.read_bytes())
    failed: list[BaseException] = []
    with (without_master("/node") as graph, mock.patch("rospy.init_node"), mock.patch("rospy.spin"),
          mock.patch("sys.argv", ["node"]), mock.patch("rosgraph.Master.lookupService"),
          mock.patch("rospy.sleep", pass_time),
          mock.patch("threading.excepthook", lambda args: failed.append(args.exc_value))):
        for topic in LISTENED:
            graph.topics[rospy.resolve_name(topic)].listeners = 1
        rospy.rostime._set_rostime(rospy.Time(10))
        node = NODES[rng.choice(sorted(NODES))]()
        begin(graph)
        topics = sorted(name for name, topic in graph.topics.items() if topic.subscribers)
        for _ in range(MESSAGES):
            topic = rng.choice(topics)
            message = carried(spoil(graph.topics[topic].kind(), rng, NAMES))
            if message is not None:
                send(graph, topic, message)
            if hasattr(node, "update"):
                node.update()
        if failed:
            raise failed[0]


def pass_time(duration: rospy.Duration) -> None:
    """The simulated clock goes on by what somebody sleeps."""
    rospy.rostime._set_rostime(rospy.Time.now() + duration)


def begin(graph: Graph) -> None:
    """What every node needs before its messages make sense: a map, and where the robot is."""
    grid = OccupancyGrid(data=[0] * 400)
    grid.header.frame_id = "map"
    grid.info.width = grid.info.height = 20
    grid.info.resolution, grid.info.origin.orientation.w = 0.5, 1.0
    send(graph, "/map", grid)
    for parent, child in itertools.pairwise(FRAMES):
        for second in (0, 20):
            send(graph, "/tf", TFMessage([transform_message(
                np.zeros(3), parent, child, rospy.Time(second, 1))]))


def send(graph: Graph, topic: str, message: Any) -> None:
    """To all who subscribed."""
    message._connection_header = {"callerid": "/other"}
    for subscriber in list(graph.topics[topic].subscribers):
        subscriber.take(message)


TARGETS = (Target("nodes", "seed", st.binary(min_size=4, max_size=8), use_node, ()),)
