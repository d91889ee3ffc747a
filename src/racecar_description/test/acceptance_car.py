"""What the acceptance tests share: where the car really is, what its controllers say, waiting."""

import math
import subprocess
import time
import xmlrpc.client
from pathlib import Path
from typing import NamedTuple

import rospy
from control_msgs.msg import JointControllerState
from controller_manager_msgs.srv import ListControllers
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

LIMIT = 60.0  # s, wall, for anything that is waited for
STANDING = 0.02  # m/s: slower is standing
LEVEL = 0.01  # m: higher above the ground it drives no more
SAMPLES_STANDING = 10  # of /ground_truth, 0.2 s: so long it has to stand
WHEELBASE, WHEEL_RADIUS = 0.335, 0.05  # m
WHEELS = tuple(f"{wheel}_wheel_velocity_controller"
               for wheel in ("left_rear", "right_rear", "left_front", "right_front"))
HINGES = ("left_steering_hinge_position_controller", "right_steering_hinge_position_controller")
CONTROLLERS = ("joint_state_controller", *WHEELS, *HINGES)


def wait_until(condition, what):
    """Poll on the wall clock until condition() is true, and return it."""
    end = time.monotonic() + LIMIT
    while time.monotonic() < end and not rospy.is_shutdown():
        if answer := condition():
            return answer
        time.sleep(0.02)
    raise AssertionError(f"not within {LIMIT:.0f} s: {what}")


def init_node(name):
    """Once time is known to be simulated: rospy looks for that a single time."""
    end = time.monotonic() + LIMIT
    while not rospy.get_param("/use_sim_time", False) and time.monotonic() < end:
        time.sleep(0.05)
    rospy.init_node(name)


def call(name, kind, *arguments, **fields):
    """The answer of a service, which may not be there yet."""
    rospy.wait_for_service(name, LIMIT)
    return rospy.ServiceProxy(name, kind)(*arguments, **fields)


def controller_states():
    """Name -> state of what the car's controller manager has loaded."""
    answer = call("/racecar/controller_manager/list_controllers", ListControllers)
    return {controller.name: controller.state for controller in answer.controller}


def all_running():
    return controller_states() == dict.fromkeys(CONTROLLERS, "running")


def process_of(node):
    """Process id of a node that is up."""
    uri = rospy.get_master().lookupNode(node)[2]
    return xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())[2]


def results_folder(arguments):
    """Where rostest wants this test's results, or here where it is run by hand."""
    for word in arguments:
        if word.startswith("--gtest_output=xml:"):
            return Path(word.split(":", 1)[1]).parent
    return Path()


def xdotool(*words):
    done = subprocess.run(["xdotool", *words], capture_output=True, text=True, timeout=LIMIT)
    return done.stdout.strip()


class Sample(NamedTuple):
    """One message of /ground_truth: s, m, m, m, rad, m/s."""

    time: float
    x: float
    y: float
    z: float
    yaw: float
    speed: float


class Truth:
    """All of /ground_truth since this was made, in `samples`."""

    def __init__(self):
        self.samples = []
        self._subscriber = rospy.Subscriber("/ground_truth", Odometry, self._take, tcp_nodelay=True)
        wait_until(lambda: self.samples, "the car's place on /ground_truth")

    def _take(self, msg):
        place, turn, speed = msg.pose.pose.position, msg.pose.pose.orientation, msg.twist.twist
        yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
        self.samples.append(Sample(msg.header.stamp.to_sec(), place.x, place.y, place.z, yaw,
                                   math.hypot(speed.linear.x, speed.linear.y)))

    @property
    def now(self):
        return self.samples[-1]

    def wait_for_speed(self, speed):
        """Until it drives so fast (m/s), within 1 %."""
        wait_until(lambda: abs(self.now.speed - speed) < 0.01 * speed, f"{speed} m/s; {self.now}")

    def pass_time(self, seconds):
        """Simulated seconds."""
        end = self.now.time + seconds
        wait_until(lambda: self.now.time >= end, f"{seconds} s of simulated time")

    def time_until_standing(self, since):
        """Simulated s from `since` until it stood; fails where it has left the ground by then."""
        def standing():
            """The samples of the last rest, if it is a rest by now."""
            later = [each for each in self.samples if each.time >= since]
            moving = [i for i, each in enumerate(later) if each.speed >= STANDING]
            rest = later[moving[-1] + 1 if moving else 0:]
            return rest if len(rest) >= SAMPLES_STANDING else None

        rest = wait_until(standing, f"standing; {self.now}")
        assert abs(rest[0].z) < LEVEL, f"off the ground: {rest[0]}"
        return rest[0].time - since

    def place(self, x, y, yaw):
        """Put the car there, at rest; its wheels must stand already."""
        wanted = ModelState(model_name="racecar", reference_frame="world")
        wanted.pose.position.x, wanted.pose.position.y = x, y
        wanted.pose.orientation.z = math.sin(yaw / 2)
        wanted.pose.orientation.w = math.cos(yaw / 2)
        assert call("/gazebo/set_model_state", SetModelState, wanted).success
        wait_until(lambda: math.hypot(self.now.x - x, self.now.y - y) < 0.01, f"{x}, {y}")
        self.time_until_standing(self.now.time)


class Driver:
    """Publishes `command` on /motor_output 20 times a simulated second."""

    def __init__(self):
        self.command = Twist()
        self._publisher = rospy.Publisher("/motor_output", Twist, queue_size=1, tcp_nodelay=True)
        wait_until(self._publisher.get_num_connections, "motor_control")
        self._timer = rospy.Timer(rospy.Duration(0.05), self._publish)

    def _publish(self, _event):
        self._publisher.publish(self.command)

    def drive(self, speed, angle):
        """m/s and rad."""
        self.command.linear.x, self.command.angular.z = speed, angle

    def end(self):
        self._timer.shutdown()
        self._publisher.unregister()


class StateOf(NamedTuple):
    """One JointControllerState: s, and rad or rad/s of what is wanted and what is."""

    time: float
    set_point: float
    value: float


class ControllerStates:
    """`history[controller]`: what the six say on their state topics, 100 times a second."""

    def __init__(self):
        self.history = {name: [] for name in WHEELS + HINGES}
        self.gains = {}  # controller: (p, i, d)
        self._subscribers = [
            rospy.Subscriber(f"/racecar/{name}/state", JointControllerState, self._take, name,
                             tcp_nodelay=True)
            for name in self.history]
        wait_until(lambda: all(self.history.values()), "the controllers' states")

    def _take(self, msg, name):
        self.gains[name] = msg.p, msg.i, msg.d
        stamp = msg.header.stamp.to_sec()
        self.history[name].append(StateOf(stamp, msg.set_point, msg.process_value))

    def time_until_zero(self, since):
        """Simulated s from `since` until all four wheels were told to stand."""
        def zeros(name):
            return [each.time for each in self.history[name]
                    if each.time >= since and each.set_point == 0]

        wait_until(lambda: all(zeros(name) for name in WHEELS), "wheels told to stand")
        return max(zeros(name)[0] for name in WHEELS) - since
