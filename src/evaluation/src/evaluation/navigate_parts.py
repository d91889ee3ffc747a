"""The run's two parts: mapping, and goals on that map, to which move_base drives the robot."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Callable
from pathlib import Path

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from terminal_language import heading

from evaluation import navigate_score
from evaluation.house import MAP, Watch, told_pose
from evaluation.live import LiveDrive
from evaluation.navigate_score import Result
from evaluation.report import write_json
from map_server.map_files import read_map
from nav_algorithms.poses import compose, invert
from run_session.launch import Launched
from run_session.processes import Child, CpuMeter
from run_session.simulator import pose_message
from trial_worlds.house import Ground

FOLDER = "new_map"  # in the folder for results


def place_for_map(out: Path) -> Path:
    """Path of the YAML file to save a map as, in an emptied folder."""
    folder = out / FOLDER
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder / "map.yaml"


def keep_map(made: Path, map_in_world: np.ndarray) -> None:
    """Move it to the folder for results, with its frame's pose in the world (3,), m and rad."""
    write_json({"map_in_world": map_in_world.tolist()}, made.with_suffix(".json"))
    folder = made.parent
    for path in folder.iterdir():
        path.replace(folder.parent / path.name)
    folder.rmdir()


def read_map_frame(path: Path) -> np.ndarray:
    """`map_in_world` (3,) from the file beside a map's YAML file; zeros if there is none."""
    for beside in (path.with_suffix(".json"), path.parent / "report.json"):  # the 2nd: older runs
        try:
            found = np.array(json.loads(beside.read_text(encoding="utf-8"))["map_in_world"], float)
        except (OSError, ValueError, KeyError, TypeError):
            continue
        if found.shape == (3,):
            return found
    return np.zeros(3)


LIMIT, LIMIT_FACTOR = 60.0, 5.0  # for a goal: s, simulated, plus a factor on the shortest time
CANCEL_LIMIT = 10.0  # s, simulated, for move_base to cancel a goal
TURN_RATE = 0.6  # rad/s
STANDING = 0.3  # s, simulated, at a goal before the pose is measured
DONE = (actionlib.CommState.DONE, actionlib.CommState.LOST)
TIME_IS_UP = "time is up"
LOOK_PERIOD = 0.05  # s, wall
END_LIMIT = 30.0  # s, wall, for all nodes of one launch file to end
SAVE_LIMIT = 60.0  # s, wall, for map_saver
LAST_MAP_LIMIT = 3.0  # s, simulated; slam_gmapping's map comes every 2 s
TOLD_OFF = (0.3, 0.3, 0.26)  # m in x and y, and rad: largest error of the initial pose
SIMULATOR = ("roslaunch", "evaluation", "house.launch")
SLAM = ("roslaunch", "turtlebot3_slam", "turtlebot3_slam.launch", "slam_methods:=gmapping",
        "open_rviz:=false")
MOVE_BASE = ("roslaunch", "evaluation", "move_base.launch")
NAVIGATION = ("roslaunch", "evaluation", "navigation.launch")


class Part:
    """One part of the run: its programs, and the robot that they drive on a map."""

    def __init__(self, name: str, run: LiveDrive, ground: Ground, watch: Watch, launched: Launched):
        self.name, self.ground, self.watch, self.options = name, ground, watch, run.options
        self._progress, self._launched = run.progress, launched
        self._children: list[Child] = []

    def start(self, *commands: tuple[str, ...]) -> None:
        """Start programs, the simulator first, with new records; wait for map and localisation."""
        self.watch.begin()
        house, options = self.options.house, self.options
        x, y, yaw = house.start
        self._start_one(
            "simulator", *SIMULATOR, f"world_name:={house.world_path}", f"x_pos:={x}",
            f"y_pos:={y}", f"yaw:={yaw}", f"model:={house.model}", f"seed:={options.seed}",
            f"real_time_factor:={options.real_time_factor:g}")
        self.wait_for("the robot in the simulator", lambda: self.watch.records.truth)
        self.watch.feelers = self.ground.feelers(rospy.get_param("/robot_description"))
        for number, command in enumerate(commands, start=1):
            self._start_one(f"navigation-{number}", *command, f"model:={house.model}")
        self.wait_for("the map and the transform map to odom",
                      lambda: self.watch.map is not None and self.watch.records.believed)

    def _start_one(self, name: str, *command: str) -> None:
        self._children.append(self._launched.start(f"{self.name}-{name}", list(command)))

    def wait_for(self, what: str, condition: Callable[[], object]) -> None:
        """Returns once the condition is true; RunError if that takes too long."""
        self._launched.wait_for(what, condition, self.options.startup_timeout,
                                lambda text: self._progress.status(f"{self.name}: {text}"))

    def connect(self, map_in_world: np.ndarray) -> None:
        """Wait for move_base; `map_in_world` (3,) is the pose of the map's frame in the world."""
        self._map_in_world = map_in_world
        self._client = actionlib.ActionClient("/move_base", MoveBaseAction)
        self._commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self._told = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)
        self.wait_for("move_base", lambda: self._client.wait_for_server(rospy.Duration(0.01)))

    def begin(self) -> None:
        """From here on the robot may drive; time and CPU use are counted."""
        self._cpu, self._began = CpuMeter(), time.monotonic()
        self.watch.records.begun = self.watch.records.now

    def figures(self) -> dict:
        """How long it took since `begin`, what the processes used, and what was seen."""
        records, wall = self.watch.records, time.monotonic() - self._began
        simulated = records.now - records.begun
        share = {name: round(percent * wall / max(simulated, 1e-9), 1)  # s in 100 simulated s
                 for name, percent in sorted(self._cpu.look().items(), key=lambda item: -item[1])}
        return {"simulated_s": round(simulated, 1), "wall_s": round(wall, 1),
                "real_time_factor": round(simulated / wall, 3) if wall > 0 else 0.0,
                "cpu_percent_of_a_core": share, **navigate_score.seen_of(records)}

    def look(self, what: str) -> None:
        """Waits a little, checks that everything still runs, shows progress."""
        time.sleep(LOOK_PERIOD)
        records = self.watch.records
        self._launched.check_time(records.now, self.options.stuck_timeout)
        records.show(self._progress, self.name, what)

    def look_for(self, seconds: float, what: str, command: Twist | None = None) -> None:
        """Look for so long, s, simulated, and meanwhile drive by the command."""
        until = self.watch.records.now + seconds
        while self.watch.records.now < until:
            if command is not None:
                self._commands.publish(command)
            self.look(what)

    def drive_to(self, goal: np.ndarray, what: str) -> dict:
        """Send the goal (3,), in the world's frame; its figures when move_base is done or time is
        up."""
        records, speed = self.watch.records, self.options.house.max_speed
        start, began, before = records.true_pose, records.now, records.length
        shortest = self.ground.shortest_way(start, goal)
        until = began + LIMIT + LIMIT_FACTOR * min(shortest, 100.0) / speed
        sent = self._client.send_goal(self._goal(goal))
        text = None
        while sent.get_comm_state() not in DONE:
            left = np.linalg.norm(records.true_pose[:2] - goal[:2])
            self.look(f"{what}, {left:.1f} m off")
            if records.now > until and text is None:
                text, until = TIME_IS_UP, records.now + CANCEL_LIMIT
                sent.cancel()
            elif records.now > until:
                break
        took = records.now - began
        self.look_for(STANDING, heading("standing"))  # until the resting pose has been observed
        return navigate_score.way(
            goal.tolist(), records.true_pose,
            text is None and sent.get_goal_status() == GoalStatus.SUCCEEDED,
            text or sent.get_goal_status_text(), time_s=round(took, 1),
            straight_s=round(float(np.linalg.norm(goal[:2] - start[:2])) / speed, 1),
            shortest_s=navigate_score.finite(shortest / speed, 1),
            driven_m=round(records.length - before, 3))

    def tell_pose(self) -> tuple[float, float]:
        """Publish an initial pose as from rviz, off by an error from the seed: that, m and rad."""
        self.wait_for("localisation and drive", lambda: min(
            self._told.get_num_connections(), self._commands.get_num_connections()))
        off = np.random.default_rng([self.options.seed, 1]).uniform(-1, 1, 3) * TOLD_OFF
        pose = self.watch.records.true_pose + off
        on_map = compose(invert(self._map_in_world), pose)
        self._told.publish(told_pose(on_map, self.watch.records.now))
        return float(np.linalg.norm(off[:2])), float(abs(off[2]))

    def turn_round(self, what: str) -> None:
        """Turn once on the spot, timed by simulated time."""
        command = Twist()
        command.angular.z = TURN_RATE
        self.look_for(2 * np.pi / TURN_RATE, what, command)
        self._commands.publish(Twist())

    def _goal(self, goal: np.ndarray) -> MoveBaseGoal:
        on_map = compose(invert(self._map_in_world), goal)
        message = MoveBaseGoal()
        message.target_pose.header.frame_id = MAP
        message.target_pose.header.stamp = rospy.Time.from_sec(self.watch.records.now)
        message.target_pose.pose = pose_message(tuple(on_map.tolist()))
        return message

    def save_map(self) -> Path:
        """Save the complete map by map_saver; returns its YAML file."""
        self.look_for(LAST_MAP_LIMIT, "waiting for the last map")
        made = place_for_map(self.options.out)
        self._launched.run("map_saver", ["rosrun", "map_server", "map_saver", "-f",
                                         str(made.with_suffix(""))], SAVE_LIMIT)
        return made

    def path(self) -> np.ndarray:
        """Where the robot was (N, 2), m, in the world."""
        return np.array(self.watch.records.truth).reshape(-1, 4)[:, 1:3]

    def end(self) -> None:
        """Ends this part's programs in reverse order of starting."""
        for child in reversed(self._children):
            self._progress.status(f"{self.name}: ending {child.name}")
            self._launched.end(child, END_LIMIT)
        self._children.clear()


def map_house(part: Part, result: Result) -> None:
    """move_base drives to the way-points on the map that slam_gmapping is building, which is then
    saved; `result` is filled even if this fails."""
    part.start(SLAM, MOVE_BASE)
    watch, house = part.watch, part.options.house
    # The map frame's pose, as a user who clicks in rviz would see it.
    result.map_in_world = compose(watch.records.true_pose, invert(watch.records.believed_pose))
    part.connect(result.map_in_world)
    part.begin()
    points = np.array(house.way_points)
    yaws = np.arctan2(*np.diff(points, axis=0, append=points[:1]).T[::-1])
    try:
        ways = [part.drive_to(np.array([*point, yaw]), f"way-point {number}/{len(points)}")
                for number, (point, yaw) in enumerate(zip(points, yaws), start=1)]
        made = part.save_map()
    finally:
        result.paths[part.name] = part.path()
    result.map, driven = read_map(made)[0], part.figures()
    figures, result.map_in_world = navigate_score.mapping_figures(
        part.ground, result.map, watch.records, watch.beams, house.laser_reach)
    result.mapping = {**driven, **figures, "way_points": ways}
    keep_map(made, result.map_in_world)


def visit_goals(part: Part, result: Result, map_file: str, goals: np.ndarray) -> None:
    """Visits the goals (N, 3), in the world's frame, localised on the saved map from a slightly
    wrong initial pose; `result` is filled even if this fails."""
    part.start((*NAVIGATION, f"map_file:={map_file}"))
    part.connect(result.map_in_world)
    told = part.tell_pose()
    part.begin()
    part.turn_round("turning round to find itself")
    since, ways = part.watch.records.now, []
    try:
        for number, goal in enumerate(goals, start=1):
            ways.append(part.drive_to(goal, f"goal {number}/{len(goals)}"))
    finally:
        result.paths[part.name] = part.path()
        _, errors = part.watch.records.errors(since, result.map_in_world)
        result.navigation = {**part.figures(), **navigate_score.localisation(told, errors),
                             "goals": ways}
