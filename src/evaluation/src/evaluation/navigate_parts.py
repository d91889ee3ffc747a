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
from evaluation.navigate_score import Way
from evaluation.report import write_json
from map_server.map_files import read_map
from nav_algorithms.poses import compose, invert, relative, wrap_angle
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

Look = Callable[[str], None]  # waits a little, checks that everything still runs, shows progress


class Driver:
    """Drives on a map; `map_in_world` (3,) is the pose of its frame in the world."""

    def __init__(self, watch: Watch, ground: Ground, look: Look, map_in_world: np.ndarray,
                 max_speed: float):
        self._watch, self._ground, self._look = watch, ground, look
        self._map_in_world, self._max_speed = map_in_world, max_speed
        self._client = actionlib.ActionClient("/move_base", MoveBaseAction)
        self._commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self._told = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)

    @property
    def is_connected(self) -> bool:
        """Whether move_base's action server is connected."""
        return self._client.wait_for_server(rospy.Duration(0.01))

    @property
    def is_heard(self) -> bool:
        """Whether there are subscribers to initial poses (localisation) and velocity commands."""
        return min(self._told.get_num_connections(), self._commands.get_num_connections()) > 0

    def drive_to(self, goal: np.ndarray, what: str) -> Way:
        """Send the goal (3,), in the world's frame; return when move_base is done or time is up."""
        records = self._watch.records
        start, began, before = records.true_pose, records.now, records.length
        shortest = self._ground.shortest_way(start, goal)
        until = began + LIMIT + LIMIT_FACTOR * min(shortest, 100.0) / self._max_speed
        sent = self._client.send_goal(self._goal(goal))
        text = None
        while sent.get_comm_state() not in DONE:
            left = np.linalg.norm(records.true_pose[:2] - goal[:2])
            self._look(f"{what}, {left:.1f} m off")
            if records.now > until and text is None:
                text, until = TIME_IS_UP, records.now + CANCEL_LIMIT
                sent.cancel()
            elif records.now > until:
                break
        took = records.now - began
        self._let_stand()
        reached = text is None and sent.get_goal_status() == GoalStatus.SUCCEEDED
        end = records.true_pose
        return Way(
            tuple(goal.tolist()), reached, text or sent.get_goal_status_text(),
            took, records.length - before,
            float(np.linalg.norm(goal[:2] - start[:2])), shortest,
            float(np.linalg.norm(end[:2] - goal[:2])), float(abs(wrap_angle(end[2] - goal[2]))))

    def tell_pose(self, pose: np.ndarray) -> None:
        """Publish an initial pose (3,), in the world's frame, as rviz's 2D Pose Estimate does."""
        on_map = compose(invert(self._map_in_world), pose)
        self._told.publish(told_pose(on_map, self._watch.records.now))

    def turn_round(self, what: str) -> None:
        """Turn once on the spot, timed by simulated time."""
        records = self._watch.records
        until = records.now + 2 * np.pi / TURN_RATE
        command = Twist()
        command.angular.z = TURN_RATE
        while records.now < until:
            self._commands.publish(command)
            self._look(what)
        self._commands.publish(Twist())

    def _let_stand(self) -> None:
        """Wait until the robot's resting pose has been observed."""
        until = self._watch.records.now + STANDING
        while self._watch.records.now < until:
            self._look(heading("standing"))

    def _goal(self, goal: np.ndarray) -> MoveBaseGoal:
        on_map = compose(invert(self._map_in_world), goal)
        message = MoveBaseGoal()
        message.target_pose.header.frame_id = MAP
        message.target_pose.header.stamp = rospy.Time.from_sec(self._watch.records.now)
        message.target_pose.pose = pose_message(tuple(on_map.tolist()))
        return message


LOOK_PERIOD = 0.05  # s, wall
END_LIMIT = 30.0  # s, wall, for all nodes of one launch file to end
SAVE_LIMIT = 60.0  # s, wall, for map_saver
LAST_MAP_LIMIT = 3.0  # s, simulated; slam_gmapping's map comes every 2 s
TOLD_OFF, TOLD_OFF_YAW = 0.3, 0.26  # m in x and y, and rad: largest error of the initial pose
SIMULATOR = ("roslaunch", "evaluation", "house.launch")
SLAM = ("roslaunch", "turtlebot3_slam", "turtlebot3_slam.launch", "slam_methods:=gmapping",
        "open_rviz:=false")
MOVE_BASE = ("roslaunch", "evaluation", "move_base.launch")
NAVIGATION = ("roslaunch", "evaluation", "navigation.launch")


class Part:
    """Shared by both parts: start programs, wait for them, supervise them, end them."""

    name = ""

    def __init__(self, run: LiveDrive, ground: Ground, watch: Watch, launched: Launched):
        self._run, self._ground, self._watch, self._launched = run, ground, watch, launched
        self._options, self._progress = run.options, run.progress
        self._children: list[Child] = []
        self._began, self._begin_time = time.monotonic(), 0.0  # s: wall, simulated
        self._driver: Driver | None = None
        self._cpu: CpuMeter | None = None

    def _start(self, *commands: tuple[str, ...]) -> None:
        """Start programs, the simulator first, with new records."""
        self._watch.begin()
        house, options = self._options.house, self._options
        x, y, yaw = house.start
        self._start_one(
            "simulator", *SIMULATOR, f"world_name:={house.world_path}", f"x_pos:={x}",
            f"y_pos:={y}", f"yaw:={yaw}", f"model:={house.model}", f"seed:={options.seed}",
            f"real_time_factor:={options.real_time_factor:g}")
        self._wait_for("the robot in the simulator", lambda: self._watch.records.truth)
        self._watch.feelers = self._ground.feelers(rospy.get_param("/robot_description"))
        for number, command in enumerate(commands, start=1):
            self._start_one(f"navigation-{number}", *command, f"model:={house.model}")

    def _start_one(self, name: str, *command: str) -> None:
        self._children.append(self._launched.start(f"{self.name}-{name}", list(command)))

    def _wait_for(self, what: str, condition: Callable[[], object]) -> None:
        self._launched.wait_for(what, condition, self._options.startup_timeout,
                                lambda text: self._progress.status(f"{self.name}: {text}"))

    def _connect(self, map_in_world: np.ndarray) -> Driver:
        self._driver = Driver(self._watch, self._ground, self._look, map_in_world,
                              self._options.house.max_speed)
        self._wait_for("move_base", lambda: self._driver.is_connected)
        return self._driver

    def _begin(self) -> None:
        """From here on the robot may drive; time and CPU use are counted."""
        self._cpu = CpuMeter()
        self._began, self._begin_time = time.monotonic(), self._watch.records.now
        self._watch.records.begun = self._begin_time

    def _pace(self) -> navigate_score.Pace:
        simulated = self._watch.records.now - self._begin_time
        wall = time.monotonic() - self._began
        used = self._cpu.look()  # percent of a core in wall time
        share = {name: round(percent * wall / max(simulated, 1e-9), 1)
                 for name, percent in sorted(used.items(), key=lambda item: -item[1])}
        return navigate_score.Pace(simulated, wall, share)

    def _look(self, what: str) -> None:
        """Waits a little, checks that everything still runs, shows progress."""
        time.sleep(LOOK_PERIOD)
        records = self._watch.records
        self._launched.check_time(records.now, self._options.stuck_timeout)
        records.show(self._progress, self.name, what)

    def end(self) -> None:
        """Ends this part's programs in reverse order of starting."""
        for child in reversed(self._children):
            self._progress.status(f"{self.name}: ending {child.name}")
            self._launched.end(child, END_LIMIT)
        self._children.clear()


class MappingPart(Part):
    """Mapping: move_base drives on the map that slam_gmapping is building."""

    name = "mapping"

    def run(self, result: navigate_score.Result) -> None:
        """Drives to the waypoints and saves the map; `result` is filled even if this fails."""
        self._start(SLAM, MOVE_BASE)
        watch, house = self._watch, self._options.house
        self._wait_for("the first map and the transform map to odom",
                       lambda: watch.map is not None and watch.records.believed)
        # The map frame's pose, as a user who clicks in rviz would see it.
        result.map_in_world = compose(watch.records.true_pose, invert(watch.records.believed_pose))
        driver = self._connect(result.map_in_world)
        ways = []
        self._begin()
        points = np.array(house.way_points)
        yaws = np.arctan2(*np.diff(points, axis=0, append=points[:1]).T[::-1])
        try:
            for number, (point, yaw) in enumerate(zip(points, yaws), start=1):
                what = f"way-point {number}/{len(points)}"
                ways.append(driver.drive_to(np.array([*point, yaw]), what))
            made = self._save()
        finally:
            result.paths[self.name] = np.array(watch.records.truth).reshape(-1, 4)[:, 1:3]
        result.map = read_map(made)[0]
        result.mapping = navigate_score.score_mapping(
            self._ground, result.map, watch.records, watch.beams, house.laser_reach, ways,
            self._pace())
        result.map_in_world = result.mapping.trajectory.alignment
        keep_map(made, result.map_in_world)

    def _save(self) -> Path:
        """Save the complete map by map_saver; returns its YAML file."""
        until = self._watch.records.now + LAST_MAP_LIMIT
        while self._watch.records.now < until:
            self._look("waiting for the last map")
        made = place_for_map(self._options.out)
        self._launched.run("map_saver", ["rosrun", "map_server", "map_saver", "-f",
                                         str(made.with_suffix(""))], SAVE_LIMIT)
        return made


class NavigationPart(Part):
    """Goals: localisation on the saved map, from a slightly wrong initial pose."""

    name = "goals"

    def run(self, result: navigate_score.Result, map_file: str, goals: np.ndarray) -> None:
        """Visits the goals (N, 3), in the world's frame; `result` is filled even if this fails."""
        self._start((*NAVIGATION, f"map_file:={map_file}"))
        watch = self._watch
        self._wait_for("the map and the transform map to odom",
                       lambda: watch.map is not None and watch.records.believed)
        driver = self._connect(result.map_in_world)
        self._wait_for("localisation and drive", lambda: driver.is_heard)
        told = self._tell_pose(driver)
        self._begin()
        driver.turn_round("turning round to find itself")
        since, ways = watch.records.now, []
        try:
            for number, goal in enumerate(goals, start=1):
                ways.append(driver.drive_to(goal, f"goal {number}/{len(goals)}"))
        finally:
            records = watch.records
            result.paths[self.name] = np.array(records.truth).reshape(-1, 4)[:, 1:3]
            _, errors = records.errors(since, result.map_in_world)
            result.navigation = navigate_score.Navigation(
                **navigate_score.seen_of(records), ways=ways, pace=self._pace(),
                localisation=navigate_score.localisation(told, errors))

    def _tell_pose(self, driver: Driver) -> tuple[float, float]:
        """Publishes an initial pose with an error drawn from the seed; returns it, m and rad."""
        generator = np.random.default_rng([self._options.seed, 1])
        off = generator.uniform(-1, 1, 3) * (TOLD_OFF, TOLD_OFF, TOLD_OFF_YAW)
        true = self._watch.records.true_pose
        told = np.array([*(true[:2] + off[:2]), wrap_angle(true[2] + off[2])])
        driver.tell_pose(told)
        return float(np.linalg.norm(relative(true, told)[:2])), float(abs(off[2]))
