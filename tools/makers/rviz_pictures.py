"""Pictures of rviz, on a screen that nobody sees, in scenes of the lessons."""

from __future__ import annotations

import math
import os
import struct
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
import rosgraph
import rospkg
import rospy
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import Twist
from std_srvs.srv import Empty

from run_session.failure import RunError
from run_session.launch import Launched
from run_session.processes import Child

WIDTH_PX, HEIGHT_PX = 1200, 846  # the windows of the shipped rviz configurations
STATUS_PX = 28  # the lowest line of rviz; its frames a second are never the same
HEADER = struct.Struct(">25I")  # of an XWD file
COLOUR_BYTES = 12  # of an entry of its colour table
STEP, STILL_LIMIT = 0.4, 20.0  # s, wall, between two looks, and until the picture stands still


class Screen:
    """As a context: Xvfb runs on a free display."""

    def __enter__(self) -> Screen:
        self._folder = tempfile.TemporaryDirectory(prefix="screen-")
        reader, writer = os.pipe()
        size = f"{WIDTH_PX}x{HEIGHT_PX}x24"
        command = ["Xvfb", "-displayfd", str(writer), "-screen", "0", size, "-nocursor",
                   "-nolisten", "tcp", "-fbdir", self._folder.name]
        try:
            self._process = subprocess.Popen(command, pass_fds=[writer], stderr=subprocess.DEVNULL)
        except OSError as error:
            raise RunError(f"Xvfb cannot be started: {error.strerror}; make setup") from error
        os.close(writer)
        with os.fdopen(reader) as answer:
            self._display = f":{answer.readline().strip()}"
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.wait()
        self._folder.cleanup()

    @property
    def environment(self) -> dict[str, str]:
        """What a program needs to draw there, by the processor and so everywhere alike."""
        return {"DISPLAY": self._display, "LIBGL_ALWAYS_SOFTWARE": "1", "QT_X11_NO_MITSHM": "1",
                "XDG_RUNTIME_DIR": self._folder.name}

    def picture(self) -> np.ndarray:
        """What is on it now: (HEIGHT_PX, WIDTH_PX, 3) uint8, BGR."""
        return _read_xwd((Path(self._folder.name) / "Xvfb_screen0").read_bytes())

    def still_picture(self) -> np.ndarray:
        """The same when nothing changes any more; RunError if it never stands still."""
        until = time.monotonic() + STILL_LIMIT
        before = self.picture()
        while time.monotonic() < until:
            time.sleep(STEP)
            now = self.picture()
            if np.array_equal(now[:-STATUS_PX], before[:-STATUS_PX]):
                return now
            before = now
        raise RunError(f"the screen changed for {STILL_LIMIT:.0f} s without end")


def save(path: Path, picture: np.ndarray) -> None:
    """As PNG, small; the status line of rviz is left out."""
    cv2.imwrite(str(path), picture[:-STATUS_PX], [cv2.IMWRITE_PNG_COMPRESSION, 9])


def _read_xwd(content: bytes) -> np.ndarray:
    """Pixels of 4 bytes, blue first, as Xvfb has them at 24 bits of depth."""
    header = HEADER.unpack_from(content)
    size, width, height, row_bytes, colours = (header[i] for i in (0, 4, 5, 12, 19))
    start = size + colours * COLOUR_BYTES
    pixels = np.frombuffer(content, np.uint8, row_bytes * height, start)
    return pixels.reshape(height, row_bytes // 4, 4)[:, :width, :3].copy()


LIMIT, END_LIMIT = 180.0, 20.0  # s, wall, for whatever is waited for, and for a launch to end
LOOK = 0.05  # s, wall
WARM_UP = 4.0  # s, wall, from rviz's first subscription until it draws what it hears of
SPEED, TURN = 0.2, 0.8  # m/s, rad/s, of the drive along a way
NEAR, ASIDE = 0.08, 0.3  # m to a point that is reached; rad off its direction to turn on the spot


class Stage:
    """One master, one screen, and the robot `model` of the simulator."""

    def __init__(self, launched: Launched, screen: Screen, images: Path | None, model: str):
        """`images`: the folder of all pictures; None: each package's own."""
        self._launched, self._screen, self._images = launched, screen, images
        self._model = model
        self._commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self._state = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)
        self.scratch = launched.log_folder

    @contextmanager
    def launch(self, package: str, name: str, *arguments: str, shows: str = "") -> Iterator[None]:
        """A launch file for as long as the context lasts; with rviz, if it `shows` a topic."""
        command = ["roslaunch", package, f"{name}.launch", *arguments]
        child = self._launched.start(name, command)
        try:
            if shows:
                self.until(lambda: _publishes(shows), f"{shows} by {name}.launch")
                self.until(lambda: "/rviz" in _nodes(), "rviz")
                time.sleep(WARM_UP)
            yield
        finally:
            self._launched.end(child, END_LIMIT)

    def run(self, *command: str) -> None:
        """One command of a README to its end."""
        self._launched.run(Path(command[2]).stem, list(command), LIMIT)

    def start(self, *command: str) -> Child:
        """One that goes on; `end` ends it."""
        return self._launched.start(Path(command[2]).stem, list(command))

    def end(self, child: Child) -> None:
        """Ends what `start` gave."""
        self._launched.end(child)

    def until(self, condition: Callable[[], object], what: str) -> None:
        """RunError where it does not come true, or something has died before."""
        until = time.monotonic() + LIMIT
        while not condition():
            self._launched.check(None)
            if time.monotonic() > until:
                raise RunError(f"not within {LIMIT:.0f} s: {what}", self._launched.tail())
            time.sleep(LOOK)

    def wait_for_robot(self) -> None:
        """Until it stands in the world."""
        rospy.wait_for_service("/gazebo/get_model_state", LIMIT)
        self.until(lambda: self._state(self._model, "").success, f"the robot {self._model}")

    def distance_to(self, x: float, y: float) -> float:
        """Of the robot from a place in the world, m."""
        here = self._state(self._model, "").pose.position
        return math.hypot(x - here.x, y - here.y)

    def drive(self, *way: tuple[float, float]) -> None:
        """Along points (x, y) in the world, m, slowly enough for a map; then it stands."""
        for x, y in way:
            self.until(lambda x=x, y=y: self._is_at(x, y), f"the robot at {x}, {y}")
        self._commands.publish(Twist())

    def drive_to(self, x: float, y: float, degrees: float, left: float) -> Child:
        """By send_goal.py, until the robot has `left` m to go; the command is still running."""
        child = self.start("rosrun", "nav_demo", "send_goal.py", str(x), str(y), str(degrees))
        self.until(lambda: self.distance_to(x, y) < left, f"the robot on its way to {x}, {y}")
        return child

    def picture(self, package: str, name: str) -> None:
        """What rviz shows, with time held; as PACKAGE/images/NAME.png."""
        rospy.ServiceProxy("/gazebo/pause_physics", Empty)()
        try:
            shown = self._screen.still_picture()
        finally:
            rospy.ServiceProxy("/gazebo/unpause_physics", Empty)()
        folder = self._images or Path(rospkg.RosPack().get_path(package)) / "images"
        folder.mkdir(parents=True, exist_ok=True)
        save(folder / f"{name}.png", shown)
        print(folder / f"{name}.png", flush=True)

    def _is_at(self, x: float, y: float) -> bool:
        """Whether it is there; else one more command on the way."""
        pose = self._state(self._model, "").pose
        here, turned = pose.position, pose.orientation
        yaw = 2 * math.atan2(turned.z, turned.w)
        aside = math.remainder(math.atan2(y - here.y, x - here.x) - yaw, math.tau)
        command = Twist()
        command.angular.z = max(-TURN, min(TURN, 2 * aside))
        command.linear.x = SPEED if abs(aside) < ASIDE else 0.0
        self._commands.publish(command)
        return math.hypot(x - here.x, y - here.y) < NEAR


def nav_demo(stage: Stage) -> None:
    """The six lessons in the room of urdf02_gazebo."""
    with stage.launch("urdf02_gazebo", "demo02_obstacles", "gui:=false"):
        stage.wait_for_robot()
        saved = stage.scratch / "my_map"
        with stage.launch("nav_demo", "nav01_slam", shows="/map"):
            stage.drive((0.9, 0.0), (0.6, 0.3))
            stage.picture("nav_demo", "nav01")
            stage.drive((0.0, 1.4), (-1.5, 1.4), (-1.5, -1.4), (0.3, -1.5), (0.0, 0.0), (0.3, 0.0))
            stage.run("rosrun", "map_server", "map_saver", "-f", str(saved))
        with stage.launch("nav_demo", "nav03_map_server", f"map_file:={saved}.yaml", shows="/map"):
            stage.picture("nav_demo", "nav02")
        with stage.launch("nav_demo", "nav03_map_server", shows="/map"):
            stage.picture("nav_demo", "nav03")
        _localise(stage)
        with stage.launch("nav_demo", "nav05_test", shows="/move_base/current_goal"):
            sent = stage.drive_to(1.5, -1.5, 90, left=1.2)
            stage.picture("nav_demo", "nav05")
            stage.end(sent)
        _restart(stage)
        with stage.launch("nav_demo", "nav06_auto_slam", shows="/move_base/current_goal"):
            sent = stage.drive_to(-1.4, 1.4, 0, left=1.2)
            stage.picture("nav_demo", "nav06")
            stage.end(sent)


def _localise(stage: Stage) -> None:
    """Lesson 4: a guess everywhere, and together again."""
    _restart(stage)
    with stage.launch("nav_demo", "nav04_test", shows="/particlecloud"):
        stage.drive((0.8, 0.0), (0.4, 0.6))
        stage.picture("nav_demo", "nav04")
        stage.run("rosservice", "call", "/global_localization")
        stage.picture("nav_demo", "nav04_everywhere")
    _restart(stage)


def _restart(stage: Stage) -> None:
    """The robot is where it was spawned."""
    rospy.ServiceProxy("/gazebo/reset_world", Empty)()


def turtlebot3_slam(stage: Stage) -> None:
    """A map of turtlebot3_world, half made."""
    with stage.launch("turtlebot3_gazebo", "turtlebot3_world"):
        stage.wait_for_robot()
        with stage.launch("turtlebot3_slam", "turtlebot3_slam", "slam_methods:=gmapping",
                          shows="/map"):
            stage.drive((-0.55, -0.55), (-0.55, 0.55), (0.55, 0.55))
            stage.picture("turtlebot3_slam", "slam")


def turtlebot3_navigation(stage: Stage) -> None:
    """On the way to a place in turtlebot3_world."""
    start = ["initial_pose_x:=-2.0", "initial_pose_y:=-0.5"]
    with stage.launch("turtlebot3_gazebo", "turtlebot3_world"):
        stage.wait_for_robot()
        with stage.launch("turtlebot3_navigation", "turtlebot3_navigation", *start,
                          shows="/move_base/current_goal"):
            sent = stage.drive_to(0.5, 1.7, 0, left=1.5)
            stage.picture("turtlebot3_navigation", "navigation")
            stage.end(sent)


def racecar(stage: Stage) -> None:
    """The road between two walls: a map of it, and a goal on that map."""
    package = rospkg.RosPack().get_path("racecar_description")
    stage.run("rosrun", "racecar_description", "make_track", f"{package}/tracks/racetrack.yaml",
              "--walls", "--name", "walled", "--out", str(stage.scratch))
    world = [f"world_name:={stage.scratch}/worlds/walled.world", "gui:=false"]
    with stage.launch("racecar_description", "mapping", "keyboard:=false", *world, shows="/map"):
        stage.wait_for_robot()
        follower = stage.start("rosrun", "car_control", "lane_follow.py", "_max_speed:=1.0")
        stage.until(lambda: stage.distance_to(2.0, 2.9) < 0.6, "the car after 17 m")
        stage.picture("racecar_description", "mapping")
        stage.end(follower)
    drawn = f"map_file:={stage.scratch}/maps/walled.yaml"
    with stage.launch("racecar_description", "navigation", drawn, *world,
                      shows="/move_base/current_goal"):
        stage.wait_for_robot()
        sent = stage.drive_to(6.0, 3.0, 90, left=4.0)
        stage.picture("racecar_description", "navigating")
        stage.end(sent)


SCENES: dict[str, tuple[str, Callable[[Stage], None]]] = {  # the robot's name, and what it does
    "nav_demo": ("mycar", nav_demo),
    "turtlebot3_slam": ("turtlebot3_waffle", turtlebot3_slam),
    "turtlebot3_navigation": ("turtlebot3_waffle", turtlebot3_navigation),
    "racecar": ("racecar", racecar),
}


def _publishes(topic: str) -> bool:
    published = rosgraph.Master("/lesson_pictures").getPublishedTopics("")
    return any(name == topic for name, _ in published)


def _nodes() -> set[str]:
    state = rosgraph.Master("/lesson_pictures").getSystemState()
    return {node for kind in state for _, nodes in kind for node in nodes}
