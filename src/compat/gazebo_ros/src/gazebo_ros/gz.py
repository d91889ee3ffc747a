"""Gazebo's command `gz`: sdf, model, world and topic; a line for what has no counterpart here."""

import argparse
import logging
import os
import shlex
import sys
from pathlib import Path
from xml.etree import ElementTree

import rosgraph
import rospy
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import (
    DeleteModel,
    GetModelProperties,
    GetModelState,
    GetWorldProperties,
    SetModelState,
)
from geometry_msgs.msg import Point, Pose, Quaternion
from node_basics.running import simulators
from std_srvs.srv import Empty

from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_entity, load_world
from bullet_sim.formats.sdf.include import model_file
from bullet_sim.formats.sdf.writing import VERSION, sdf_text
from bullet_sim.formats.xml_text import decoded, parse_xml, read_xml_file
from bullet_sim.pose import quaternion_from_rpy, rpy_from_quaternion
from bullet_sim_ros.package_paths import open_resources

ELSEWHERE = {
    "camera": "roslaunch sim_viewer viewer.launch, for the page in the browser",
    "debug": "rosrun gazebo_ros debug",
    "joint": "rosservice call /gazebo/set_joint_properties, or /gazebo/apply_joint_effort",
    "log": "rosbag record -a",
    "marker": "roslaunch sim_viewer viewer.launch, whose page shows visualization_msgs/Marker",
    "physics": "rosservice call /gazebo/set_physics_properties",
    "stats": "rostopic echo /gazebo/performance_metrics",
}
NOT_RUNNING = ("An instance of Gazebo is not running on this master. Start one, as with: "
               "roslaunch gazebo_ros empty_world.launch")
ROSTOPIC = ("info", "echo", "hz", "bw")
ONE_WORLD = "accepted; there is only one world"
PLACE = ("x", "y", "z", "R", "P", "Y")  # m, and rad about fixed axes


class GzError(Exception):
    """The command failed; the message is the line to print."""


class _Mistakes(logging.Handler):
    """Counts the lines about what a file has wrong."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.number = 0

    def emit(self, record: logging.LogRecord) -> None:
        self.number += 1


def parser() -> argparse.ArgumentParser:
    """Gazebo 11's commands and options, as far as they have a meaning here."""
    result = argparse.ArgumentParser(prog="gz", allow_abbrev=False, description=__doc__)
    commands = result.add_subparsers(dest="command", required=True)
    sdf = commands.add_parser("sdf", help="check or print a file")
    what = sdf.add_mutually_exclusive_group(required=True)
    what.add_argument("-k", "--check", metavar="FILE", help="is it valid?")
    what.add_argument("-p", "--print", metavar="FILE", help="as SDF; a URDF file is converted")
    what.add_argument("-v", "--version", action="store_true", help="of SDF")

    model = commands.add_parser("model", help="list, spawn, move or delete models")
    model.add_argument("-l", "--list", action="store_true", help="the names of all")
    model.add_argument("-m", "--model-name", metavar="NAME", help="of one model")
    model.add_argument("-d", "--delete", action="store_true")
    model.add_argument("-f", "--spawn-file", metavar="FILE", help="URDF or SDF")
    model.add_argument("-s", "--spawn-string", action="store_true", help="SDF from a pipe")
    model.add_argument("-w", "--world-name", metavar="NAME", help=ONE_WORLD)
    model.add_argument("-i", "--info", action="store_true", help="its links and joints")
    model.add_argument("-p", "--pose", action="store_true", help="print x y z R P Y")
    for name in PLACE:
        model.add_argument(f"-{name}", f"--pose-{name}", dest=f"to_{name}", type=float, metavar="N")

    world = commands.add_parser("world", help="pause or reset")
    world.add_argument("-w", "--world-name", metavar="NAME", help=ONE_WORLD)
    world.add_argument("-s", "--step", action="store_true", help="one step of a paused world")
    world.add_argument("-m", "--multi-step", type=_steps, metavar="N", help="N of them")
    world.add_argument("-p", "--pause", type=int, choices=(0, 1), help="1: pause, 0: go on")
    world.add_argument("-r", "--reset-all", action="store_true", help="time and models")
    world.add_argument("-o", "--reset-models", action="store_true")

    topic = commands.add_parser("topic", help="ROS topics, by rostopic")
    of_topic = topic.add_mutually_exclusive_group(required=True)
    of_topic.add_argument("-l", "--list", action="store_true")
    for letter, name in zip("iezb", ROSTOPIC):
        of_topic.add_argument(f"-{letter}", f"--{name}", metavar="TOPIC")
    return result


def _steps(text: str) -> int:
    """A number of steps, for argparse."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number of steps, 1 or more")
    return int(text)


def run_sdf(options: argparse.Namespace) -> None:
    """Check or print a file."""
    if options.version:
        print(VERSION)
        return
    name, resources = options.check or options.print, open_resources()
    if "://" in name:
        name = str(model_file(resources.resolve(name)))
    root, mistakes = _root(name), _Mistakes()
    logging.getLogger("bullet_sim").addHandler(mistakes)
    if root.tag != "robot" and root.find("world") is not None:
        load_world(name, resources)
    else:
        model = load_entity(ElementTree.tostring(root, encoding="unicode"), resources)
    if options.print:
        print(sdf_text(model) if root.tag == "robot"
              else ElementTree.tostring(root, encoding="unicode"))
    if mistakes.number:
        raise GzError(f"{name} has mistakes: {mistakes.number}; each is a line above")
    if options.check:
        print("Check complete")


def _root(name: str) -> ElementTree.Element:
    if not Path(name).is_file():
        raise GzError(f"Unable to find file {name!r}")
    return read_xml_file(Path(name))


def run_model(options: argparse.Namespace) -> None:
    """One action on models, by the simulator's services."""
    if options.list:
        print("\n".join(_call("get_world_properties", GetWorldProperties).model_names))
    elif options.spawn_string:
        _spawn_piped(options)
    elif options.spawn_file:
        _spawn(options)
    elif not options.model_name:
        raise GzError("which model? Type: gz model -m NAME; gz model --list prints the names")
    elif options.delete:
        _call("delete_model", DeleteModel, options.model_name)
    elif options.info:
        print(_call("get_model_properties", GetModelProperties, options.model_name))
    elif options.pose:
        print(" ".join(f"{value:.6f}" for value in _place(options.model_name)))
    else:
        _move(options)


def _spawn(options: argparse.Namespace) -> None:
    path = Path(options.spawn_file)
    root = _root(options.spawn_file)
    kind = "-urdf" if root.tag == "robot" else "-sdf"
    model = root if root.tag == "robot" else root.find("model")
    name = options.model_name or ("" if model is None else model.get("name", "")) or path.stem
    _become_spawn_model(options, kind, "-file", str(path), "-model", name)


def _become_spawn_model(options: argparse.Namespace, *words: str) -> None:
    place = [word for axis, value in _given(options).items() for word in (f"-{axis}", str(value))]
    _become("rosrun", "gazebo_ros", "spawn_model", *words, *place,
            "-gazebo_namespace", _simulator())


def _spawn_piped(options: argparse.Namespace) -> None:
    text, name = decoded(sys.stdin.buffer.read()), options.model_name
    if not name:
        found = parse_xml(text, "stdin").find("model")
        name = "" if found is None else found.get("name", "")
    if not name:
        raise GzError("what is piped has no <model name=>; type: gz model -s -m NAME")
    copy = os.memfd_create("model")  # for the next program to read once more
    os.write(copy, text.encode())
    os.lseek(copy, 0, os.SEEK_SET)
    os.dup2(copy, sys.stdin.fileno())
    _become_spawn_model(options, "-sdf", "-stdin", "-model", name)


def _move(options: argparse.Namespace) -> None:
    given = _given(options)
    if not given:
        raise GzError("what is to be done with the model? Type: gz model --help")
    place = dict(zip(PLACE, _place(options.model_name))) | given
    pose = Pose(Point(place["x"], place["y"], place["z"]),
                Quaternion(*quaternion_from_rpy(place["R"], place["P"], place["Y"])))
    _call("set_model_state", SetModelState,
          ModelState(model_name=options.model_name, pose=pose))


def _given(options: argparse.Namespace) -> dict[str, float]:
    return {name: value for name in PLACE
            if (value := getattr(options, f"to_{name}")) is not None}


def _place(name: str) -> tuple[float, ...]:
    pose = _call("get_model_state", GetModelState, name, "").pose
    at, turn = pose.position, pose.orientation
    return (at.x, at.y, at.z, *rpy_from_quaternion((turn.x, turn.y, turn.z, turn.w)))


def run_world(options: argparse.Namespace) -> None:
    """Pause, go on, step, or reset."""
    if options.pause is not None:
        _call("pause_physics" if options.pause else "unpause_physics", Empty)
    elif options.reset_all:
        _call("reset_simulation", Empty)
    elif options.reset_models:
        _call("reset_world", Empty)
    elif options.step or options.multi_step is not None:
        for _ in range(1 if options.step else options.multi_step):
            _call("step_physics", Empty)
    else:
        raise GzError("what is to be done? Type: gz world --help")


def run_topic(options: argparse.Namespace) -> None:
    """Gazebo's own topics have none of their own here: rostopic looks at ROS's."""
    if options.list:
        _become("rostopic", "list")
    action = next(name for name in ROSTOPIC if getattr(options, name))
    _become("rostopic", action, getattr(options, action))


def _become(*words: str) -> None:
    os.execvp(words[0], words)


def _simulator() -> str:
    """The full name of the simulator to talk to; GzError if there is none."""
    try:
        own = rospy.resolve_name("gazebo")
        running = simulators("get_world_properties")
    except (OSError, rosgraph.MasterException):
        raise GzError(NOT_RUNNING) from None
    except ValueError as error:  # ROS_MASTER_URI is no URI, or ROS_NAMESPACE no name
        raise GzError(str(error)) from None
    return chosen(running, own, sys.argv[1:])


def chosen(running: list[str], own: str, words: list[str]) -> str:
    """Of the simulators that run that of our own namespace, or the only one.

    GzError with what to type, given gz's arguments, if there are none or several others.
    """
    if not running:
        raise GzError(NOT_RUNNING)
    if own in running:
        return own
    if len(running) > 1:
        namespace = running[0].removesuffix("/gazebo").strip("/")
        raise GzError(f"several simulators run: {', '.join(running)}. Name the namespace of one, "
                      f"as in: ROS_NAMESPACE={namespace} {shlex.join(['gz', *words])}")
    return running[0]


def _call(name: str, kind: type, *request):
    """The answer of the simulator's service; GzError if there is none, or if it says no."""
    try:
        answer = rospy.ServiceProxy(f"{_simulator()}/{name}", kind)(*request)
    except rospy.ServiceException as error:
        raise GzError(str(error)) from None
    if not getattr(answer, "success", True):
        raise GzError(answer.status_message)
    return answer


def main() -> int:
    """The exit code: 0, 1 after a line that says what failed, 2 for a wrong command line."""
    logging.basicConfig(format="%(levelname)s: %(message)s")
    words = sys.argv[1:]
    if words and words[0] in ELSEWHERE:
        print(f"gz {words[0]} has no counterpart here. Type: {ELSEWHERE[words[0]]}",
              file=sys.stderr)
        return 1
    options = parser().parse_args(["--help" if word == "help" else word for word in words[:1]]
                                  + words[1:])
    run = {"sdf": run_sdf, "model": run_model, "world": run_world, "topic": run_topic}
    try:
        run[options.command](options)
    except (GzError, SimulationError) as error:
        print(f"gz {options.command}: {error}", file=sys.stderr)
        return 1
    return 0
