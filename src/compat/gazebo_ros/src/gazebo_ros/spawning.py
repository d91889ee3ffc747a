"""What spawn_model does after its command line: wait, load, spawn, set joints, unpause, delete."""

import signal
import sys
import threading

import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import DeleteModel
from geometry_msgs.msg import Point, Pose, Quaternion
from std_srvs.srv import Empty

from bullet_sim.pose import quaternion_from_rpy
from gazebo_ros import gazebo_interface, model_source, spawn_arguments
from gazebo_ros.quiet_end import end_quietly
from gazebo_ros.service_wait import wait_for_service

POLL_PERIOD = 0.1  # s


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
    options = spawn_arguments.parser().parse_args(rospy.myargv()[1:])
    try:
        positions = spawn_arguments.joint_positions(options.joints)
        end_quietly()
        rospy.init_node("spawn_model", anonymous=True)
        return run(options, positions)
    except ValueError as error:
        print(error, file=sys.stderr)
    except rospy.ROSInitException as error:  # Ctrl-C while it looks for the master
        print(f"spawn_model: {error}", file=sys.stderr)
    except rospy.ROSInterruptException:
        print("spawn_model: stopped before it was done", file=sys.stderr)
    return 1
