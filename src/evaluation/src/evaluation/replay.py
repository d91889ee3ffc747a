"""`make replay`: goes back to an image of a run in lockstep, and lets it drive on from there."""

from __future__ import annotations

import contextlib
import os
import queue
import shutil
import sys
import threading
import time
import xmlrpc.client
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import rosgraph
import rospy
from controller_manager_msgs.srv import ListControllers
from std_srvs.srv import Empty, Trigger, TriggerRequest, TriggerResponse

from bullet_sim.formats.run_log import PastEnd, RunLog, RunLogError, read_run_log
from evaluation.command_line import NOT_PASSED, PASSED, Parser, results_folder, run_program
from evaluation.launch_without import LEFT_OUT
from evaluation.run_log import EARLIER, RUN_LOG, begin_run_log
from evaluation.run_page import RUN_PAGE
from run_session import simulator
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.master import is_up, look_up
from run_session.observer import missing_controller
from run_session.session import LOG, Session

PROGRAM = "replay"
START_LIMIT = 300.0  # s, wall; as long as a run's start may take
REPLAY_LIMIT = 3600.0  # s, wall
LOOK_PERIOD = 0.1  # s, wall
COMMANDS = ("n", "p", "go", "q", "help")
GO_TO_IMAGE = "/gazebo/go_to_image"
WENT_ON = "the world has gone on by itself"  # begins the simulator's answer
NEW = "new.run.log.gz"  # of the world that is gone back to, as long as it runs
OF = ("words", "driver", "sensor", "commands", "controllers", "environment")


class NotThere(Exception):
    """The image was not reached as in the run; one line."""


class WentOn(Exception):
    """The world has left the run: the page, or a service, has let it go on."""


class Order(NamedTuple):
    """A command that was typed, or called as a service."""

    word: str
    done: Callable[[bool, str], None]  # told whether it was carried out, and a line


def log_path(run: Path) -> Path:
    """The log of a run: of its folder, its own path, or its path without `.run.log.gz`.

    RunError if there is none, which names the film if there is one.
    """
    for path in (run, run / RUN_LOG, run.with_name(f"{run.name}.{RUN_LOG}")):
        if path.is_file():
            return path
    if not run.is_dir():
        raise RunError(f"no run at {run} (RUN=): give the folder of its results, as out/course")
    film = next((run / name for name in (RUN_PAGE, "run.mp4") if (run / name).exists()), None)
    raise RunError(f"{run} has no {RUN_LOG}: only a run in lockstep, as by FAST=1, can be "
                   f"repeated, not one in real time{_look_at(film)}")


def _look_at(film: Path | None) -> str:
    return f"; look at its film: {film}" if film is not None and film.exists() else ""


def image_of(log: RunLog, path: Path, at: str) -> tuple[int, str]:
    """The image's number, and a line to say; RunError if the log does not lead there."""
    said = ""
    try:
        number = log.find(at)
    except RunLogError as error:
        if log.whole or not isinstance(error, PastEnd):
            raise RunError(f"{path}: {error}") from None
        number = len(log.images)
        said = f"the log was cut short: it ends at image {number}, which is gone to"
    for event in log.events[:log.events.index(log.images[number - 1])]:
        if event.kind == "lacks":
            raise RunError(f"{path}: at {log.time_of(event):.3f} s the run used {event.name}, "
                           f"which is not in its log{_look_at(path.with_name(RUN_PAGE))}")
    return number, said


class Replay:
    """A run that is gone back to. Each way back is a new simulator."""

    def __init__(self, session: Session, path: Path, log: RunLog):
        self._session, self._path, self._log = session, path, log
        self._of = log.header["run"]
        self._launched: Launched | None = None
        self._world = None  # roslaunch's process
        self._image = 0
        self._on_log = False  # whether the world stands at that image
        self._orders: queue.SimpleQueue[Order] = queue.SimpleQueue()

    def open(self, page: Sequence[str] | None, master: str = "") -> None:
        """Start a master, or use this one, and, unless `page` is None, the page, with these
        arguments."""
        self._launched = launched = self._session.launched(
            "robot", self._of["driver"], environment=self._of["environment"], joined=True,
            master=master)
        launched.start_roscore()
        rospy.init_node(PROGRAM, anonymous=False, disable_signals=True, disable_rosout=True)
        for name, word in (("next_image", "n"), ("previous_image", "p")):
            rospy.Service(f"~{name}", Trigger, lambda _request, word=word: self._wait_for(word))
        rospy.Service("~carry_out", Trigger,  # of the page's time bar
                      lambda _request: self._wait_for(str(rospy.get_param("~word"))))
        # A copy: `keep` may move the log itself.
        replayed = shutil.copy(self._path, self._session.out / LOG / RUN_LOG)
        rospy.set_param("/gazebo/replay", str(replayed))
        begin_run_log(launched.master_uri, self._session.out / NEW, **self._of)
        if page is not None:
            launched.start("viewer", ["roslaunch", "sim_viewer", "viewer.launch", *page])
            launched.wait_for("the page in the browser",
                              lambda: rospy.has_param("/sim_viewer/url"), START_LIMIT)
            self._say(f"the page in the browser: {rospy.get_param('/sim_viewer/url')}")
        if master:  # which goes on with other worlds
            self._session.at_end(_forget)
            return
        self._say("another terminal joins by: source devel/setup.bash; export "
                  f"ROS_MASTER_URI={launched.master_uri}")

    def keep(self) -> None:
        """Once the world has ended: its log becomes the folder's, if it has gone on by itself."""
        new, kept = self._session.out / NEW, self._session.out / RUN_LOG
        try:
            went_on = 0 < self._image <= len(read_run_log(new).images)
        except (OSError, RunLogError):  # there was no world, or no room
            went_on = False
        if not went_on:
            new.unlink(missing_ok=True)
            return
        if kept.exists():
            kept.replace(kept.with_name(EARLIER))
        new.replace(kept)

    def go_to(self, number: int) -> None:
        """Bring a world to the image; NotThere if it is not as in the run, WentOn if it left it."""
        if not self._on_log or number <= self._image:
            self._start_world()
        rospy.set_param("/gazebo/replay_to", number)
        began, passed = time.monotonic(), self._time(number) - self._time(self._image)
        answer = self._call()
        self._on_log = answer.success
        if answer.message.startswith(WENT_ON):
            raise WentOn
        self._image = number
        if not answer.success:
            raise NotThere(answer.message)
        took = time.monotonic() - began
        image = self._log.images[number - 1]
        self._say(f"image {number} of {len(self._log.images)}, {self._time(number):.3f} s: the "
                  f"state is the run's ({image.data.hex()})")
        if passed > 1.0:
            self._say(f"{passed:.1f} s in {took:.1f} s, {passed / took:.1f} x real time")

    def stay(self) -> None:
        """Carry out commands until q or Ctrl-C."""
        self._say(self._help())
        threading.Thread(target=self._read, daemon=True).start()
        while True:
            self._launched.check(None)
            try:
                order = self._orders.get(timeout=LOOK_PERIOD)
            except queue.Empty:
                continue
            if order.word == "q":
                return
            try:
                order.done(True, self._carry_out(order.word))
            except (NotThere, RunError) as error:
                order.done(False, str(error))

    # --- commands

    def _carry_out(self, word: str) -> str:
        if word == "go":
            return self._drive_on()
        if word == "help":
            return self._help()
        number, said = {"n": (self._image + 1, ""), "p": (self._image - 1, "")}.get(word) or \
            image_of(self._log, self._path, word)
        if not 1 <= number <= len(self._log.images):
            raise RunError(f"the log has image 1 to {len(self._log.images)}")
        with contextlib.suppress(WentOn):
            if word != "n" or self._on_log:
                self.go_to(number)
                return said
        if word == "n":
            raise RunError("the world goes on by itself; p or a time goes back into the run")
        self.go_to(number)
        return said

    def _help(self) -> str:
        marks = dict.fromkeys(mark.name for mark in self._log.marks)
        there = ", ".join(["12.5", "image:700", *marks, "end"])
        return (f"n: the next image; p: the previous one; {there}: there; go: drive on; q: end; "
                "help: this line")

    def _drive_on(self) -> str:
        """Unpause, once a program is connected; the world then waits for its answers."""
        if missing := self._missing_driver():
            raise RunError(f"{missing}: in another terminal, start the program that drives, "
                           f"such as {self._driver()}; then drive on again (go)")
        self._on_log = False
        simulator.call(simulator.UNPAUSE, Empty)
        return "the world goes on, in lockstep; p or a time goes back into the run"

    def _missing_driver(self) -> str | None:
        sensor, commands = self._of["sensor"], self._of["commands"]
        try:
            found = look_up(self._launched.master_uri, rospy.get_name(), (sensor, commands))
        except (OSError, xmlrpc.client.Error, rosgraph.MasterException) as error:
            return f"the ROS master does not answer ({error})"
        if not found.publishers[commands] - {"/sim_viewer"}:
            return f"no program sends {commands}"
        if not found.subscribers[sensor] - {"/sim_viewer"}:
            return f"no program reads {sensor}"
        return found.missing_link(sensor) or found.missing_link(commands)

    def _driver(self) -> str:
        lines = self._world.log.read_text(encoding="utf-8", errors="replace").splitlines()
        left_out = (line.removeprefix(LEFT_OUT) for line in lines if line.startswith(LEFT_OUT))
        return f"rosrun {next(left_out, self._of['driver'])}"

    def _wait_for(self, word: str) -> TriggerResponse:
        """In a ROS thread: have it carried out."""
        answers: queue.SimpleQueue[TriggerResponse] = queue.SimpleQueue()
        self._orders.put(Order(word, lambda *answer: answers.put(TriggerResponse(*answer))))
        return answers.get()

    def _read(self) -> None:
        """In a thread: commands from the terminal, until its end."""
        def say(_done: bool, line: str) -> None:
            if line:
                self._say(line)
        for line in sys.stdin or ():
            if word := line.strip():
                command = word.lower()
                self._orders.put(Order(command if command in COMMANDS else word, say))
        if sys.stdin and sys.stdin.isatty():  # Ctrl-D
            self._orders.put(Order("q", say))

    # --- the simulator

    def _start_world(self) -> None:
        launched = self._launched
        if self._world is not None:
            launched.end(self._world)
            self.keep()
        self._image, self._on_log = 0, False
        self._world = launched.start("roslaunch", [
            sys.executable, "-m", "evaluation.launch_without", self._of["driver"],
            *self._of["words"]])
        spawned = sum("/spawn_" in name for name, _ in self._log.setup)
        launched.wait_for("the robot in the world",
                          lambda: len(simulator.models()) >= max(1, spawned), START_LIMIT)
        if self._of["controllers"]:
            launched.wait_for("the robot's controllers", self._controllers_started, START_LIMIT)

    def _controllers_started(self) -> bool:
        service = f"{self._of['controllers'].rstrip('/')}/{simulator.LIST_CONTROLLERS}"
        try:
            found = rospy.ServiceProxy(service, ListControllers)().controller
        except simulator.FAILURES:
            return False
        return missing_controller({each.name: each.state for each in found}, set()) is None

    def _call(self) -> TriggerResponse:
        """Call the simulator, and see meanwhile whether it lives."""
        answers: list[TriggerResponse] = []

        def call() -> None:
            try:
                answers.append(rospy.ServiceProxy(GO_TO_IMAGE, Trigger)(TriggerRequest()))
            except simulator.FAILURES as error:
                answers.append(TriggerResponse(False, str(error)))

        thread = threading.Thread(target=call, daemon=True)
        thread.start()
        self._launched.wait_for("the image that is gone to", lambda: not thread.is_alive(),
                                REPLAY_LIMIT)
        return answers[0]

    def _time(self, number: int) -> float:
        return self._log.time_of(self._log.images[number - 1]) if number else 0.0

    def _say(self, text: str) -> None:
        self._session.progress.say(text)


def _forget() -> None:
    for name in ("replay", "replay_to", "run_log", "run_log_of"):
        with contextlib.suppress(KeyError, OSError, rosgraph.MasterException):
            rospy.delete_param(f"/gazebo/{name}")


def run(arguments: Sequence[str]) -> int:
    """Go there, and stay; returns the exit code."""
    parser = Parser(prog="replay.py", description="Go back to an image of a run in lockstep.",
                    epilog="Exit code: 0 the world was there, 1 its state differs from the run's, "
                           "2 could not run.")
    add = parser.add_argument
    add("--run", type=Path, default=Path("out/course"), metavar="RUN",
        help="folder of a run's results, or a log in it (out/course)")
    add("--at", default="end", metavar="AT",
        help="s of simulated time, image:N, lost, lap, lap:2, contact, largest, a program's mark, "
             "or end (end)")
    add("--control", action="store_true", help="the page may drive, pause and set")
    parser.add_whole("--port", 8080, "of the page", most=65535, least=1)
    add("--once", action="store_true", help="go there, say whether it is as in the run, and end")
    add("--here", action="store_true",
        help="at the ROS master of this terminal, which runs already, without a page of its own")
    add("--out", type=Path, default=Path("out/replay"), metavar="DIR",
        help="where logs go (out/replay)")
    options = parser.parse_args(arguments)
    path = log_path(options.run)
    try:
        log = read_run_log(path)
    except RunLogError as error:
        raise RunError(str(error)) from None
    number, said = image_of(log, path, options.at)
    if missing := [name for name in OF if name not in log.header.get("run", {})]:
        raise RunError(f"{path} does not say how its run was started ({missing[0]}): only runs of "
                       "make course, race, track, lane and avoid can be gone back to")
    page = [f"port:={options.port}", f"control:={str(options.control).lower()}"]
    master = os.environ.get("ROS_MASTER_URI", "") if options.here else ""
    if options.here and not is_up(master):
        raise RunError(f"no ROS master at {master or 'ROS_MASTER_URI'} (--here)")
    out = options.out.resolve()
    with (results_folder(PROGRAM, out), contextlib.ExitStack() as ended,
          Session(out) as session):
        replay = Replay(session, path, log)
        ended.callback(replay.keep)
        if said:
            session.progress.say(said)
        replay.open(None if options.once or options.here else page, master)
        try:
            replay.go_to(number)
        except NotThere as error:
            print(f"{PROGRAM}: {error}", file=sys.stderr)
            return NOT_PASSED
        if not options.once:
            replay.stay()
    return PASSED


def main() -> int:
    """Run with the command line."""
    return run_program(PROGRAM, lambda: run(sys.argv[1:]))
