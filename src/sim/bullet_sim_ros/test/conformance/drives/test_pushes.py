"""What moves links and joints by itself: forces, a hand, trajectories, lifts, winches."""

import pytest
import rospy
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3, Wrench
from geometry_msgs.msg import Pose as PoseMsg
from std_msgs.msg import Bool, Float32, String
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from bullet_sim.pose import Pose

FORCE = "libgazebo_ros_force.so"
HAND = "libgazebo_ros_hand_of_god.so"
TRAJECTORY = "libgazebo_ros_joint_pose_trajectory.so"
ELEVATOR = "libgazebo_ros_elevator.so"
HARNESS = "libgazebo_ros_harness.so"
SLIP = "libgazebo_ros_wheel_slip.so"


# --- force

@pytest.fixture
def pushed(bench, robots):
    """`pushed(tag=value)`: a weightless cube of 2 kg with the force plugin."""
    def make(**tags):
        bench.world.configure_physics(gravity=(0.0, 0.0, 0.0))
        return bench.spawn(robots.cube("cube", robots.plugin(FORCE, **{
            "bodyName": "body", "topicName": "push", **tags}), mass=2.0), Pose((0, 0, 1.0)))
    return make


def test_a_force_acts_for_ever_in_world_axes(bench, pushed):
    # conforms: libgazebo_ros_force.so, libgazebo_ros_force.so/bodyName
    # conforms: libgazebo_ros_force.so/topicName
    cube = pushed()
    bench.send("/push", Wrench(force=Vector3(0, 4, 0)))
    bench.run(0.5)
    assert cube.twist.linear == pytest.approx((0, 1, 0), abs=0.01)
    bench.run(0.5)
    assert cube.twist.linear == pytest.approx((0, 2, 0), abs=0.01)
    bench.send("/push", Wrench(torque=Vector3(0, 0, 0.01)))
    bench.run(0.5)
    assert cube.twist.linear == pytest.approx((0, 2, 0), abs=0.01)
    assert cube.twist.angular[2] == pytest.approx(0.5, rel=0.02)  # 0.01 kg m^2


def test_force_names(bench, pushed, caplog):
    # conforms: libgazebo_ros_force.so/robotNamespace, libgazebo_ros_force.so/bodyName
    # conforms: libgazebo_ros_force.so/topicName
    pushed(robotNamespace="/arm")
    assert bench.subscribed()["/arm/push"] is Wrench
    bench.send("/arm/push", Wrench(force=Vector3(float("inf"), 0, 0)))
    assert "a wrench that is not finite" in caplog.text
    bench.delete("cube")
    pushed(bodyName="")
    assert "it needs a <bodyName>" in caplog.text
    bench.delete("cube")
    pushed(topicName="")
    assert "it needs a <topicName>" in caplog.text


# --- hand of god

def wanted(frame: str, x: float) -> TFMessage:
    msg = TransformStamped(child_frame_id=frame)
    msg.header.frame_id, msg.header.stamp = "world", rospy.Time(0, 1)
    msg.transform.translation.x, msg.transform.translation.z = x, 1.0
    msg.transform.rotation.z = msg.transform.rotation.w = 0.5 ** 0.5
    return TFMessage([msg])


@pytest.fixture
def held(bench, robots):
    """`held(tag=value)`: a cube in the air that a hand holds."""
    def make(**tags):
        return bench.spawn(robots.cube("cube", robots.plugin(HAND, **{"linkName": "body", **tags}),
                                       mass=1.0), Pose((0, 0, 1.0)))
    return make


def test_a_hand_takes_the_link_to_the_desired_frame(bench, held):
    # conforms: libgazebo_ros_hand_of_god.so, libgazebo_ros_hand_of_god.so/linkName
    cube = held()
    tf = bench.listen("/tf")
    bench.run(0.2)
    assert not tf  # nothing is desired yet
    assert cube.pose.position == pytest.approx((0, 0, 1.0), abs=1e-3)  # and nothing falls
    bench.send("/tf", wanted("hog_desired", 0.5))
    bench.run(1.0)
    assert cube.pose.position == pytest.approx((0.5, 0, 1.0), abs=0.01)
    assert cube.pose.rpy()[2] == pytest.approx(1.5708, abs=0.02)
    assert (tf[-1].transforms[0].header.frame_id,
            tf[-1].transforms[0].child_frame_id) == ("world", "hog_actual")
    assert tf[-1].transforms[0].transform.translation.x == pytest.approx(0.5, abs=0.01)


def test_a_frame_of_another_name_and_static_ones(bench, held):
    # conforms: libgazebo_ros_hand_of_god.so/frameId
    cube = held(frameId="pen")
    tf = bench.listen("/tf")
    bench.send("/tf_static", wanted("pen_desired", 0.3))
    bench.run(1.0)
    assert cube.pose.position[0] == pytest.approx(0.3, abs=0.01)
    assert tf[-1].transforms[0].child_frame_id == "pen_actual"


@pytest.mark.parametrize("tags, farther, turned", [
    ({}, True, True), ({"kl": 2}, False, True), ({"ka": 0.001}, True, False)])
def test_how_hard_the_hand_pulls(bench, held, tags, farther, turned):
    # conforms: libgazebo_ros_hand_of_god.so/kl, libgazebo_ros_hand_of_god.so/ka
    cube = held(**tags)
    bench.send("/tf", wanted("hog_desired", 0.5))
    bench.run(0.3)
    assert (cube.pose.position[0] > 0.3) == farther
    assert (cube.pose.rpy()[2] > 0.5) == turned


# --- trajectories of joints

@pytest.fixture
def arm(bench, robots):
    """`arm(tag=value)`: a car whose wheels are put at angles."""
    def make(**tags):
        return bench.spawn(robots.two_wheels(robots.plugin(TRAJECTORY, **tags)))
    return make


def trajectory(*rows, frame: str = "world", names=("left_joint", "right_joint"),
               start: float = 0.0) -> JointTrajectory:
    msg = JointTrajectory(joint_names=list(names))
    msg.header.frame_id, msg.header.stamp = frame, rospy.Time(start)
    for positions, seconds in rows:
        msg.points.append(JointTrajectoryPoint(positions=list(positions),
                                               time_from_start=rospy.Duration(seconds)))
    return msg


def angles(car) -> tuple[float, float]:
    return car.joints["left_joint"].position, car.joints["right_joint"].position


def test_joints_are_put_where_the_points_say_one_after_the_other(bench, arm):
    # conforms: libgazebo_ros_joint_pose_trajectory.so
    car = arm()
    bench.send("/set_joint_trajectory", trajectory(([0.5, -0.5], 0.2), ([1.0, 2.0], 0.2)))
    bench.run(0.1)
    assert angles(car) == pytest.approx((0.5, -0.5), abs=1e-6)
    bench.run(0.2)  # time_from_start is how long a point is shown
    assert angles(car) == pytest.approx((1.0, 2.0), abs=1e-6)
    bench.run(0.5)
    assert abs(car.pose.position[0]) < 0.01


def test_a_trajectory_begins_at_its_stamp(bench, arm):
    # conforms: libgazebo_ros_joint_pose_trajectory.so
    # conforms: libgazebo_ros_joint_pose_trajectory.so/robotNamespace
    # conforms: libgazebo_ros_joint_pose_trajectory.so/topicName
    car = arm(topicName="show", robotNamespace="/arm")
    bench.send("/arm/show", trajectory(([1.0, 1.0], 0.1), start=0.3))
    bench.run(0.25)
    assert angles(car) == pytest.approx((0.0, 0.0), abs=1e-3)
    bench.run(0.1)
    assert angles(car) == pytest.approx((1.0, 1.0), abs=1e-6)


def test_a_reference_link_stands_still(bench, arm):
    # conforms: libgazebo_ros_joint_pose_trajectory.so
    car = arm()
    bench.run(0.1)
    before = car.links["left"].pose
    bench.send("/set_joint_trajectory", trajectory(([0.7, 0.0], 1.0), frame="car::left"))
    bench.run(0.1)
    assert car.links["left"].pose.rpy() == pytest.approx(before.rpy(), abs=1e-4)
    assert abs(car.links["base"].pose.rpy()[1]) == pytest.approx(0.7, abs=1e-3)


@pytest.mark.parametrize("msg, said", [
    (trajectory(([0.5], 0.2)), "point 0 of the trajectory has 1 positions for 2 joints"),
    (trajectory(([0.5, float("nan")], 0.2)), "point 0 of the trajectory is not finite"),
    (trajectory(([0.5, 0.5], 0.2), frame="nowhere"), "no link named 'nowhere'")])
def test_bad_trajectories_are_said(bench, arm, caplog, msg, said):
    # conforms: libgazebo_ros_joint_pose_trajectory.so
    car = arm()
    bench.send("/set_joint_trajectory", msg)
    bench.run(0.1)
    assert said in caplog.text
    assert angles(car) == pytest.approx((0.0, 0.0), abs=1e-3)


def test_the_service_may_also_set_the_pose(bench, arm):
    # conforms: libgazebo_ros_joint_pose_trajectory.so/serviceName
    car = arm(serviceName="place")
    request = {"model_name": "car", "joint_trajectory": trajectory(([0.3, 0.3], 0.5)),
               "set_model_pose": True}
    answer = bench.call("/place", model_pose=PoseMsg(Point(2, 0, 0), Quaternion(0, 0, 0, 1)),
                        **request)
    assert answer.success
    bench.run(0.1)
    assert car.pose.position[0] == pytest.approx(2.0, abs=1e-3)
    assert angles(car) == pytest.approx((0.3, 0.3), abs=1e-6)
    bad = bench.call("/place", joint_trajectory=trajectory(([0.3], 0.5)))
    assert (bad.success, "1 positions for 2 joints" in bad.status_message) == (False, True)


# --- elevator and harness

@pytest.fixture
def lift(bench, robots):
    """`lift(tag=value)`: a cabin on a rail, with a sliding door."""
    def make(**tags):
        cabin = robots.link("cabin", "0 0 0.2 0 0 0", robots.box(1, 1, 0.1), 50.0)
        door = robots.link("door", "0.5 0 1 0 0 0", robots.box(0.05, 0.9, 1), 5.0)
        lift = robots.revolute("lift", "world", "cabin", "0 0 1", "prismatic")
        slide = robots.revolute("slide", "cabin", "door", "0 1 0", "prismatic")
        plugin = robots.plugin(ELEVATOR, **{
            "lift_joint": "lift", "door_joint": "slide", "floor_height": 0.5,
            "door_wait_time": 1, **tags})
        return bench.spawn(f'<model name="lift">{cabin}{door}{lift}{slide}{plugin}</model>')
    return make


def test_a_lift_goes_to_the_floor_opens_waits_and_closes(bench, lift):
    # conforms: libgazebo_ros_elevator.so, libgazebo_ros_elevator.so/lift_joint
    # conforms: libgazebo_ros_elevator.so/door_joint, libgazebo_ros_elevator.so/floor_height
    # conforms: libgazebo_ros_elevator.so/door_wait_time
    cabin = lift()
    bench.send("/elevator", String("2"))
    bench.run(2.5)
    assert cabin.joints["lift"].position == pytest.approx(1.0, abs=0.16)
    assert cabin.joints["slide"].position > 0.3
    bench.send("/elevator", String("0"))  # busy: ignored
    bench.run(1.5)
    assert cabin.joints["slide"].position > 0.9
    bench.run(3.0)
    assert cabin.joints["slide"].position == pytest.approx(0.0, abs=0.06)
    assert cabin.joints["lift"].position == pytest.approx(1.0, abs=0.02)


def test_lift_names_and_bounds(bench, lift, caplog):
    # conforms: libgazebo_ros_elevator.so/topic, libgazebo_ros_elevator.so/robotNamespace
    # conforms: libgazebo_ros_elevator.so/bottom_floor, libgazebo_ros_elevator.so/top_floor
    cabin = lift(topic="call", robotNamespace="/house", bottom_floor=0, top_floor=1)
    for text, said in (("2", "there is no floor 2"), ("-1", "there is no floor -1"),
                       ("up", "'up' is not a floor")):
        bench.send("/house/call", String(text))
        assert said in caplog.text
    bench.run(0.5)
    assert cabin.joints["lift"].position == pytest.approx(0.0, abs=1e-3)


HOOK = """<joint name="{}" type="prismatic"><parent>world</parent><child>body</child>
  <axis><xyz>{}</xyz></axis></joint>"""


@pytest.fixture
def hung(bench, robots):
    """`hung(inner)`: a cube that hangs at 1 m."""
    def make(inner: str):
        return bench.spawn(robots.cube("cube", robots.plugin(HARNESS).replace(
            "></", f">{inner}</")), Pose((0, 0, 1.0)))
    return make


def test_a_winch_raises_holds_and_lets_go(bench, hung):
    # conforms: libgazebo_ros_harness.so, libgazebo_ros_harness.so/joint
    # conforms: libgazebo_ros_harness.so/winch, libgazebo_ros_harness.so/detach
    cube = hung(HOOK.format("rope", "0 0 1") + HOOK.format("side", "1 0 0")
                + "<winch><joint>side</joint></winch><detach>rope</detach>")
    bench.run(0.3)
    assert cube.pose.position == pytest.approx((0, 0, 1.0), abs=1e-3)
    bench.send("/cube/harness/velocity", Float32(0.5))
    bench.run(0.5)
    assert cube.pose.position == pytest.approx((0.25, 0, 1.0), abs=5e-3)
    bench.send("/cube/harness/velocity", Float32(0.0))
    bench.run(0.3)
    assert cube.pose.position[0] == pytest.approx(0.25, abs=5e-3)
    bench.send("/cube/harness/detach", Bool(False))
    bench.run(0.1)
    assert cube.pose.position[2] > 0.99
    bench.send("/cube/harness/detach", Bool(True))
    bench.run(0.3)
    assert cube.pose.position[2] < 0.7


def test_a_harness_without_names_takes_the_first_joint(bench, hung, caplog):
    # conforms: libgazebo_ros_harness.so/winch, libgazebo_ros_harness.so/detach
    # conforms: libgazebo_ros_harness.so/joint
    hung(HOOK.format("rope", "0 0 1"))
    assert "<winch/joint> is ''; there are: rope; rope is used" in caplog.text
    bench.delete("cube")
    hung("<detach>rope</detach>")
    assert "it needs a <joint>" in caplog.text


# --- read only

def test_wheel_slip_is_checked_and_said_to_be_without_effect(bench, robots, caplog):
    # conforms: libgazebo_ros_wheel_slip.so
    inner = '<wheel link_name="left"/>'
    bench.spawn(robots.two_wheels(robots.plugin(SLIP).replace("></", f">{inner}</")))
    assert "has no effect: wheels slip only beyond their friction" in caplog.text
    bench.delete("car")
    bench.spawn(robots.two_wheels(robots.plugin(SLIP)))
    assert 'it needs a <wheel link_name="...">' in caplog.text


def test_the_template_does_nothing(bench, robots, caplog):
    # conforms: libgazebo_ros_template.so
    bench.spawn(robots.cube("cube", robots.plugin("libgazebo_ros_template.so")))
    assert not caplog.records
