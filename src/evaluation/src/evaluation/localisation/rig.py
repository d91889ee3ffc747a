"""The running simulator with the waffle, map_server and amcl, as the trials use them."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from functools import partial

import numpy as np
import rospy
from dynamic_reconfigure.msg import Config, IntParameter
from dynamic_reconfigure.srv import Reconfigure
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import PoseWithCovarianceStamped
from std_srvs.srv import Empty

from evaluation.house.watch import ROBOT, Watch, told_pose
from run_session import simulator
from run_session.cpu import processes
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.status_line import StatusLine
from trial_worlds.ground import Ground

START_LIMIT, STILL_LIMIT = 120.0, 30.0  # s, wall
LOOK_PERIOD = 0.05  # s, wall
FENCE = 0.8  # m ahead of the robot
TRUE, ENCODER = "<odometrySource>world<", "<odometrySource>encoder<"
call_service = partial(simulator.call, wait=STILL_LIMIT)


class Rig:
    """Made once per run; all of its methods may raise RunError."""

    def __init__(self, options: argparse.Namespace, ground: Ground, launched: Launched,
                 map_file: str, progress: StatusLine):
        self._launched, self._ground, self._progress = launched, ground, progress
        launched.start_roscore()
        self.watch = Watch()
        launched.start("localisation", [
            "roslaunch", "evaluation", "localisation.launch", f"map_file:={map_file}",
            f"world_name:={options.house.world_path}", f"model:={options.house.model}",
            f"seed:={options.seed}", f"real_time_factor:={options.real_time_factor:g}"])
        self._told = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)
        self._wait("the simulator", simulator.models)
        self._start, self._by_wheels = options.house.start, None
        self.use_odometry(by_wheels=True)
        self.watch.start()
        self._wait("the robot in the simulator", lambda: self.watch.records.truth)
        self._wait("the map and amcl", lambda: self.watch.map is not None
                   and self._told.get_num_connections() and self.watch.records.believed)

    @property
    def now(self) -> float:
        """Simulated time, s."""
        return self.watch.records.now

    def may_go_on(self) -> bool:
        """Whether the robot, going straight on, would stay on the map, which ends at the house."""
        truth = self.watch.records.truth
        if not truth:
            return True
        _, x, y, yaw = truth[-1]
        point = np.array([x + FENCE * np.cos(yaw), y + FENCE * np.sin(yaw)])
        walls = self._ground.walls
        return bool(walls.contains(walls.cells_of(point)))

    def use_odometry(self, by_wheels: bool) -> None:
        """Respawn the robot, if necessary, with wheel odometry, or ground truth as TurtleBot3 has.

        Ground truth would tell amcl where the robot was moved.
        """
        if self._by_wheels == by_wheels:
            return
        urdf = self._wait("the robot's description",
                          lambda: rospy.get_param("/robot_description", ""))
        if TRUE not in urdf:
            raise RunError(f"/robot_description has no {TRUE}/odometrySource>: a kidnapped robot's "
                           "odometry must not know of it")
        if self._by_wheels is not None:
            simulator.delete(ROBOT)
        simulator.spawn_urdf(ROBOT, urdf.replace(TRUE, ENCODER) if by_wheels else urdf, "/",
                             *self._start[:2])
        self._by_wheels = by_wheels
        self.watch.feelers = self._ground.feelers(urdf)

    def put(self, place: np.ndarray) -> None:
        """Move the robot to a pose (3,) in the world, unnoticed by its wheel odometry."""
        simulator.put(ROBOT, tuple(place.tolist()), STILL_LIMIT)
        self.watch.begin()
        self._wait("the robot in its place", lambda: self.watch.records.truth and np.linalg.norm(
            self.watch.records.true_pose[:2] - place[:2]) < 0.2)

    def tell(self, place: np.ndarray) -> None:
        """Publish an initial pose (3,), in the world's frame, as rviz's 2D Pose Estimate does."""
        self._told.publish(told_pose(place, self.now))

    def forget(self) -> None:
        """Call /global_localization: the robot may be anywhere."""
        call_service("/global_localization", Empty)

    def look(self, part: str, what: str) -> None:
        """Waits a little, checks that everything still runs, shows progress."""
        before, began = self.now, time.monotonic()
        while True:
            time.sleep(LOOK_PERIOD)
            self._launched.check(self.now)
            if self.now > before:
                break
            if time.monotonic() - began > STILL_LIMIT:
                raise RunError(f"no news of the robot for {STILL_LIMIT:.0f} s: the simulator hangs",
                               self._launched.tail())
        self.watch.records.show(self._progress, part, what)

    def set_pace(self, factor: float) -> None:
        """Set the real-time factor."""
        now = call_service("/gazebo/get_physics_properties", GetPhysicsProperties)
        call_service("/gazebo/set_physics_properties", SetPhysicsProperties,
                     now.time_step, factor / now.time_step, now.gravity, now.ode_config)

    def set_particles(self, count: int) -> None:
        """Have amcl use constantly this many particles."""
        names = "min_particles", "max_particles"
        answer = call_service("/amcl/set_parameters", Reconfigure,
                            Config(ints=[IntParameter(name, count) for name in names]))
        taken = {each.name: each.value for each in answer.config.ints}
        if any(taken.get(name) != count for name in names):
            raise RunError(f"amcl does not take {count} for {' and '.join(names)}")

    @staticmethod
    def cpu() -> float:
        """CPU time of amcl since its start, s."""
        return sum(process.cpu for process in processes() if process.name == "amcl")

    def _wait(self, what: str, condition: Callable[[], object]) -> object:
        return self._launched.wait_for(what, condition, START_LIMIT, self._progress.status)
