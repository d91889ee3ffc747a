"""spawn_model: its command line, then wait, load, spawn, set joints, unpause, delete.

Flags are upstream's, with long names behind a single dash.
"""

import argparse
import errno
import signal
import sys
import threading

import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import DeleteModel
from geometry_msgs.msg import Point, Pose, Quaternion
from node_basics.ending import drop_unread_output
from rosgraph import xmlrpc
from std_srvs.srv import Empty

from bullet_sim.pose import quaternion_from_rpy
from gazebo_ros import gazebo_interface, model_source
from gazebo_ros.service_wait import wait_for_service

EPILOG = "Example: spawn_model -urdf -param robot_description -model robot -z 0.1"
SOURCES = (
    ("-file", "FILE_NAME", "file"), ("-param", "PARAM_NAME", "ROS parameter"),
    ("-database", "MODEL_NAME", "model of the model path"))
SWITCHES = (
    ("-unpause", "unpause the simulation afterwards"),
    ("-package_to_model", "in mesh file names, write model:// for package://"),
    ("-b", "stay, and delete the model when this node is shut down"))
POLL_PERIOD = 0.1  # s


class EndingServer(xmlrpc.ThreadingXMLRPCServer):
    """Its loop ends when its socket has been closed.

    rospy closes the server's socket and leaves its loop running: until the process is gone, half a
    second later, that loop asks for the closed socket as fast as it can. Ten `spawn_model` that end
    while ten robots start would take most of two cores (measured: 0.5 s of a core each).
    """

    def service_actions(self) -> None:
        """Called by the loop each time round; the error is the one that rosgraph expects."""
        super().service_actions()
        if self.fileno() < 0:
            raise OSError(errno.EBADF, "the socket has been closed")


def end_quietly() -> None:
    """For this process's node; before rospy.init_node."""
    xmlrpc.ThreadingXMLRPCServer = EndingServer


def parser() -> argparse.ArgumentParser:
    result = argparse.ArgumentParser(
        prog="spawn_model", description="Spawn a model in the simulator.", epilog=EPILOG)
    language = result.add_mutually_exclusive_group(required=True)
    language.add_argument("-urdf", action="store_true", help="the XML is URDF")
    language.add_argument("-sdf", action="store_true", help="the XML is SDF")
    source = result.add_mutually_exclusive_group(required=True)
    for flag, metavar, where in SOURCES:
        source.add_argument(flag, metavar=metavar, help=f"take the XML from this {where}")
    source.add_argument("-stdin", action="store_true", help="take the XML from standard input")
    result.add_argument("-model", required=True, metavar="MODEL_NAME", help="the new name")
    result.add_argument("-reference_frame", default="", metavar="NAME",
                        help="model or model::link that the pose is seen from; default: world")
    result.add_argument("-gazebo_namespace", default="/gazebo", metavar="NS",
                        help="where the services are; default: /gazebo")
    result.add_argument("-robot_namespace", default=rospy.get_namespace(), metavar="NS",
                        help="of the model's plugins; default: this node's")
    result.add_argument("-wait", metavar="MODEL_NAME", help="first wait until this model is there")
    for flag, effect in SWITCHES:
        result.add_argument(flag, action="store_true", help=effect)
    for name in ("x", "y", "z"):
        result.add_argument(f"-{name}", type=float, default=0.0, help=f"position {name}, m")
    for name, angle in (("R", "roll"), ("P", "pitch"), ("Y", "yaw")):
        result.add_argument(f"-{name}", type=float, default=0.0, help=f"{angle}, rad")
    result.add_argument("-J", dest="joints", action="append", default=[], nargs=2,
                        metavar=("JOINT_NAME", "POSITION"), help="initial position, rad or m")
    return result


def joint_positions(joints: list[list[str]]) -> list[float]:
    """The numbers of all -J; ValueError with one clear line for a word that is none."""
    positions = []
    for name, word in joints:
        try:
            positions.append(float(word))
        except ValueError:
            raise ValueError(f"Error: -J {name} {word}: {word} is not a number") from None
    return positions


def pose_from(options) -> Pose:
    """Roll, pitch, yaw about fixed axes."""
    turn = Quaternion(*quaternion_from_rpy(options.R, options.P, options.Y))
    return Pose(Point(options.x, options.y, options.z), turn)


def wait_for_model(name: str, gazebo: str) -> None:
    """Returns when the model is there, or at shutdown."""
    rospy.loginfo(f"Waiting for model {name} before proceeding.")
    there = threading.Event()
    subscriber = rospy.Subscriber(
        f"{gazebo}/model_states", ModelStates,
        lambda states: there.set() if name in states.name else None)
    while not there.wait(POLL_PERIOD) and not rospy.is_shutdown():
        pass
    subscriber.unregister()


def spawn(options, positions: list[float]) -> bool:
    """Whether the model was spawned and its joints set; every failure is logged."""
    gazebo = options.gazebo_namespace
    client = (gazebo_interface.spawn_urdf_model_client if options.urdf
              else gazebo_interface.spawn_sdf_model_client)
    try:
        xml = model_source.load(options)
    except model_source.SourceError as error:
        log = rospy.logfatal if isinstance(error, model_source.NoSuchFileError) else rospy.logerr
        log(str(error))
        return False
    if not client(options.model, xml, options.robot_namespace, pose_from(options),
                  options.reference_frame, gazebo):
        rospy.logerr("Spawn service failed. Exiting.")
        return False
    names = [name for name, _ in options.joints]
    if names and not gazebo_interface.set_model_configuration_client(
            options.model, "", names, positions, gazebo):
        rospy.logerr("SetModelConfiguration service failed. Exiting.")
        return False
    return True


def unpause(gazebo: str) -> bool:
    rospy.loginfo("Unpausing physics")
    wait_for_service(f"{gazebo}/unpause_physics")
    try:
        rospy.ServiceProxy(f"{gazebo}/unpause_physics", Empty)()
    except rospy.ServiceException as error:
        rospy.logerr(f"Unpause physics service call failed: {error}")
        return False
    return True


def delete(name: str, gazebo: str) -> None:
    rospy.loginfo(f"Deleting model {name}")
    try:
        rospy.ServiceProxy(f"{gazebo}/delete_model", DeleteModel)(name)
    except rospy.ServiceException as error:
        rospy.logerr(f"Delete model service call failed: {error}")


def delete_on_signal(name: str, gazebo: str) -> None:
    """Stays until a signal or a shutdown by the master, then deletes the model.

    The signal only leaves a mark: rospy's handler would call the service on top of whatever line
    it interrupted, with that line's locks held.
    """
    stop_requested: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _frame: stop_requested.append(received))
    rospy.on_shutdown(lambda: delete(name, gazebo))
    rospy.loginfo(f"Waiting for shutdown to delete model {name}")
    while not stop_requested and not rospy.is_shutdown():
        rospy.rostime.wallsleep(POLL_PERIOD)
    drop_unread_output()
    rospy.signal_shutdown("terminated")


def run(options, positions: list[float]) -> int:
    """The whole sequence in a started node; returns the exit code."""
    gazebo = options.gazebo_namespace
    if options.wait:
        wait_for_model(options.wait, gazebo)
        if rospy.is_shutdown():
            return 0
    if not spawn(options, positions) or (options.unpause and not unpause(gazebo)):
        return 1
    if options.b:
        delete_on_signal(options.model, gazebo)
    return 0


def main() -> int:
    options = parser().parse_args(rospy.myargv()[1:])
    try:
        positions = joint_positions(options.joints)
        end_quietly()
        rospy.init_node("spawn_model", anonymous=True)
        return run(options, positions)
    except ValueError as error:
        print(error, file=sys.stderr)
    except rospy.ROSInterruptException:
        print("spawn_model: stopped before it was done", file=sys.stderr)
    return 1
