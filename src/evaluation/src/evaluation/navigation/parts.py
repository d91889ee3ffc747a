"""The run's two parts: mapping, and goals on that map."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import rospy

from evaluation.house.watch import Watch
from evaluation.navigation import score
from evaluation.navigation.driver import Driver
from evaluation.navigation.new_map import keep_map, place_for_map
from evaluation.trial.live import LiveDrive
from map_server.map_files import read_map
from nav_algorithms.poses import compose, invert, relative, wrap_angle
from run_session.cpu import CpuMeter
from run_session.launch import Launched
from run_session.processes import Child
from trial_worlds.ground import Ground

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

    def _pace(self) -> score.Pace:
        simulated = self._watch.records.now - self._begin_time
        wall = time.monotonic() - self._began
        used = self._cpu.look()  # percent of a core in wall time
        share = {name: round(percent * wall / max(simulated, 1e-9), 1)
                 for name, percent in sorted(used.items(), key=lambda item: -item[1])}
        return score.Pace(simulated, wall, share)

    def _look(self, what: str) -> None:
        """Waits a little, checks that everything still runs, shows progress."""
        time.sleep(LOOK_PERIOD)
        records = self._watch.records
        self._run.check_time(self._launched, records.now)
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

    def run(self, result: score.Result) -> None:
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
        result.mapping = score.score_mapping(
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

    def run(self, result: score.Result, map_file: str, goals: np.ndarray) -> None:
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
            result.navigation = score.Navigation(
                **score.seen_of(records), ways=ways, pace=self._pace(),
                localisation=score.localisation(told, errors))

    def _tell_pose(self, driver: Driver) -> tuple[float, float]:
        """Publishes an initial pose with an error drawn from the seed; returns it, m and rad."""
        generator = np.random.default_rng([self._options.seed, 1])
        off = generator.uniform(-1, 1, 3) * (TOLD_OFF, TOLD_OFF, TOLD_OFF_YAW)
        true = self._watch.records.true_pose
        told = np.array([*(true[:2] + off[:2]), wrap_angle(true[2] + off[2])])
        driver.tell_pose(told)
        return float(np.linalg.norm(relative(true, told)[:2])), float(abs(off[2]))
