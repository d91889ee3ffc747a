"""The node /gazebo: reads a world, offers Gazebo's topics and services, and runs the loop."""

import argparse
import gc
import logging
import sys
from collections.abc import Callable
from dataclasses import replace
from http.client import HTTPException
from pathlib import Path
from typing import NoReturn

import rosgraph
import rospy
from node_basics.listening import fault_of, roscore, wait_for_master
from rosgraph.names import is_legal_name

from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.run_log import RunLogError
from bullet_sim.physics.parameter_bounds import possible_physics
from bullet_sim.rendering.renderer import NoRenderer
from bullet_sim.world import World
from bullet_sim_ros import loop, names, topic_faults
from bullet_sim_ros.lockstep import split
from bullet_sim_ros.metrics import MetricsTopic
from bullet_sim_ros.only_simulator import register
from bullet_sim_ros.package_paths import open_resources, unreadable_world, why_unopened
from bullet_sim_ros.params import NodeParameters, read_node_parameters
from bullet_sim_ros.plugins import register_plugins
from bullet_sim_ros.recording import Recording
from bullet_sim_ros.replay import Replay
from bullet_sim_ros.rospy_patches import keep_every_publisher, send_promptly
from bullet_sim_ros.run_log import RunLog
from bullet_sim_ros.services import offer_services
from bullet_sim_ros.shutdown import end_before_topics, end_by_signals, shut_down
from bullet_sim_ros.simulation import Simulation
from bullet_sim_ros.state_log import StateLog
from bullet_sim_ros.state_topics import SceneTopic, StateTopics


class _ToRosout(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        logging.getLogger("rosout").log(record.levelno, "%s", record.getMessage())


def forward_core_log(verbose: bool) -> None:
    """Forward it; to be called once, after init_node."""
    core = logging.getLogger("bullet_sim")
    core.setLevel(logging.INFO if verbose else logging.WARNING)
    core.addHandler(_ToRosout())
    core.propagate = False


def open_network(simulation: Simulation, parameters: NodeParameters) -> None:
    """Open all topics and services, unless the parameter `~enable_ros_network` is false."""
    if not parameters.enable_ros_network:
        rospy.loginfo("ROS gazebo topics/services are disabled")
        return
    StateTopics(simulation, parameters.pub_state_frequency)
    MetricsTopic(simulation)
    simulation.each_turn.append(SceneTopic(simulation.world).update)
    offer_services(simulation)
    topic_faults.watch(simulation.senders)


# s: the loop and the drawing thread share the GIL; Python's default, 5 ms, is a third of a frame.
SWITCH_INTERVAL = 0.0005
FASTEST = 1000.0  # largest real-time factor; 0 means no limit
LATEST = 4e9  # s; ROS times end at 2**32 s
MASTER_LOST = (ConnectionError, HTTPException)  # raised if the master ends during a call
# As gazebo_ros_api_plugin.cpp, Load, says twice a second.
NO_MASTER = "No ROS master - start %s to continue... (looked for it at %s)"
ENGINES = ("ode", "bullet", "dart", "simbody")  # those of Gazebo 11


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Print one line only; --help shows the usage."""
        self.exit(2, f"{self.prog}: error: {message}\n")


def parse(arguments: list[str]) -> argparse.Namespace:
    """Parse the command line, from which ROS remappings are already removed."""
    parser = _Parser(prog="gzserver", description=__doc__)
    parser.add_argument("--world", default="worlds/empty.world", help="world file")
    parser.add_argument("--paused", action="store_true", help="start with time standing still")
    parser.add_argument("--physics", default="ode", help="accepted, no effect: Bullet computes")
    parser.add_argument("--seed", type=_seed, default=0, help="seed of all random numbers")
    parser.add_argument("--real-time-factor", type=_up_to(FASTEST), default=None,
                        help="1: real time, 0: no limit; default: the world's rate")
    parser.add_argument("--verbose", action="store_true", help="also show what is loaded")
    parser.add_argument("--iters", type=int, default=0, help="end after this many steps")
    parser.add_argument("--initial-sim-time", type=_up_to(LATEST), default=0.0, help="s")
    return parser.parse_args(arguments)


def _up_to(most: float) -> Callable[[str], float]:
    def number(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = -1.0
        if not 0 <= value <= most:
            raise argparse.ArgumentTypeError(f"{text!r} is not a number, 0 to {most:g}")
        return value
    return number


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, 0 or more")
    return int(text)


def open_world(options: argparse.Namespace, resources: Resources) -> World:
    """The world that the command line names; ResourceNotFound or FormatError of its file."""
    path = resources.find_world(options.world)
    description = load_world(path, resources)
    description = replace(description, physics=possible_physics(description.physics))
    if options.real_time_factor is not None:
        rate_hz = options.real_time_factor / description.physics.max_step_size
        physics = replace(description.physics, real_time_update_rate=rate_hz)
        description = replace(description, physics=physics)
    world = World(description, options.seed, options.initial_sim_time)
    world.paused = options.paused
    return world


def check_engine(name: str) -> None:
    """Log an error if the engine is not one of Gazebo's four; the simulation starts anyway."""
    if name not in ENGINES:
        rospy.logerr("There is no physics engine %r; there are %s; Bullet computes, whichever is "
                     "asked for", name, ", ".join(ENGINES))


def start(options: argparse.Namespace) -> Simulation | None:
    """The simulation with its topics and services; None if that fails, after logging why."""
    resources = open_resources()
    try:
        world = open_world(options, resources)
    except SimulationError as error:
        rospy.logfatal("%s", why_unopened(options.world, error))
        return None
    parameters = read_node_parameters()
    for name, topics in ((names.LOCKSTEP, parameters.lockstep),
                         (names.LOCKSTEP_SENSOR, parameters.lockstep_sensor)):
        if not all(is_legal_name(topic) for topic in split(topics)):
            rospy.logfatal("parameter %s is %r, which is not a topic name; for example /cmd_vel",
                           rospy.resolve_name(name), topics)
            return None
    try:
        simulation = Simulation(world, parameters, resources)
    except NoRenderer as error:
        rospy.logfatal("%s", error)
        return None
    end_by_signals(simulation.stop)  # before its topics and services are visible
    open_network(simulation, parameters)
    for kind, name, file in ((StateLog, names.STATE_LOG, parameters.state_log),
                             (Recording, names.RECORDING, parameters.recording),
                             (RunLog, names.RUN_LOG, parameters.run_log),
                             (Replay, names.REPLAY, parameters.replay)):
        try:
            if file:
                kind(simulation, Path(file))
        except OSError as error:
            rospy.logfatal("parameter %s: %s: %s", rospy.resolve_name(name), file, error.strerror)
            return None
        except RunLogError as error:
            rospy.logfatal("parameter %s: %s", rospy.resolve_name(name), error)
            return None
    return simulation


def main() -> int:
    """Run until shutdown; returns 1 if a simulator runs already, if the world cannot be opened, or
    if the master ends before."""
    options = parse(rospy.myargv(sys.argv)[1:])
    sys.setswitchinterval(SWITCH_INTERVAL)
    sys.stdout.reconfigure(line_buffering=True)  # into a file or pipe, too
    uri = rosgraph.get_master_uri()
    if fault := fault_of(uri) or (not rosgraph.is_master_online()
                                  and unreadable_world(options.world)):
        print(f"[FATAL] {fault}", file=sys.stderr)
        return 1
    wait_for_master(uri, f"[WARN] {NO_MASTER % (roscore(uri), uri)}")
    send_promptly()
    keep_every_publisher()
    try:
        if not register(options.world):
            return 1
        forward_core_log(options.verbose)
        check_engine(options.physics)
        register_plugins()
        simulation = start(options)
    except MASTER_LOST as error:
        rospy.logfatal("the ROS master at %s has ended while the simulator started: %s; start both "
                       "again", rosgraph.get_master_uri(), error)
        return 1
    if simulation is None:
        return 1
    if not rospy.is_shutdown():
        rospy.loginfo("World %s (%s) is ready", simulation.world.description.name, options.world)
    gc.freeze()  # modules and world are permanent: the collector need not scan them again
    ended = end_before_topics(simulation.stop)
    try:
        loop.run(simulation, options.iters)
    finally:
        ended.set()
        shut_down()
        simulation.close()
    return 0
