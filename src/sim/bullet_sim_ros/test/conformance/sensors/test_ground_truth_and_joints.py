"""libgazebo_ros_p3d.so and libgazebo_ros_joint_state_publisher.so."""

import math

import numpy as np
import pytest
from nav_msgs.msg import Odometry
from sensor_models import xyz
from sensor_msgs.msg import JointState

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist

ARM = """<model name="arm"><static>{static}</static>
  <link name="base"><inertial><mass>5</mass></inertial></link>
  <link name="hand"><pose>1 0 0 0 0 0</pose><inertial><mass>1</mass></inertial></link>
  <joint name="hinge" type="revolute"><parent>base</parent><child>hand</child>
    <pose>-1 0 0 0 0 0</pose><axis><xyz>0 0 1</xyz></axis></joint>
  <link name="tip"><pose>2 0 0 0 0 0</pose><inertial><mass>1</mass></inertial></link>
  <joint name="weld" type="fixed"><parent>hand</parent><child>tip</child></joint>
  {plugin}</model>"""


def arm(library: str, tags: str, static: str = "false") -> str:
    plugin = f'<plugin name="p" filename="libgazebo_ros_{library}.so">{tags}</plugin>'
    return ARM.format(static=static, plugin=plugin)


def test_p3d_in_the_world(bench):
    # conforms: libgazebo_ros_p3d.so, libgazebo_ros_p3d.so/bodyName, libgazebo_ros_p3d.so/topicName
    # conforms: libgazebo_ros_p3d.so/xyzOffset, libgazebo_ros_p3d.so/rpyOffset
    # conforms: libgazebo_ros_p3d.so/robotNamespace
    tags = """<bodyName>hand</bodyName><topicName>truth</topicName><xyzOffset>0 0 2</xyzOffset>
      <rpyOffset>0 0 1.5707963</rpyOffset><robotNamespace>/r1</robotNamespace>"""
    model = bench.spawn(arm("p3d", tags), Pose((3, 0, 9)))
    model.set_twist(Twist((0.5, 0, 0)))
    poses = bench.listen("/r1/truth")
    bench.run(0.001)
    found, = poses
    assert isinstance(found, Odometry)
    assert (found.header.frame_id, found.child_frame_id) == ("world", "hand")
    assert xyz(found.pose.pose.position) == pytest.approx([4, 0, 11], abs=1e-2)
    assert found.pose.pose.orientation.z == pytest.approx(math.sin(math.pi / 4), abs=1e-3)
    assert found.twist.twist.linear.x == pytest.approx(0.5, abs=1e-3)
    assert found.pose.covariance == found.twist.covariance == tuple([0.0] * 36) or not any(
        [*found.pose.covariance, *found.twist.covariance])


def test_p3d_from_another_link(bench):
    # conforms: libgazebo_ros_p3d.so/frameName
    tags = "<bodyName>hand</bodyName><topicName>t</topicName><frameName>base</frameName>"
    bench.spawn(arm("p3d", tags, "true"), Pose.from_xyz_rpy((3, 0, 9), (0, 0, 1)))
    poses = bench.listen("/t")
    bench.run(0.001)
    assert poses[0].header.frame_id == "base"
    assert xyz(poses[0].pose.pose.position) == pytest.approx([1, 0, 0], abs=1e-6)


@pytest.mark.parametrize("frame", ["world", "/world", "map", "/map"])
def test_frames_that_are_the_world(bench, frame):
    # conforms: libgazebo_ros_p3d.so/frameName
    tags = f"<bodyName>hand</bodyName><topicName>t</topicName><frameName>{frame}</frameName>"
    bench.spawn(arm("p3d", tags, "true"), Pose((3, 0, 9)))
    poses = bench.listen("/t")
    bench.run(0.001)
    assert poses[0].header.frame_id == frame.lstrip("/")
    assert poses[0].pose.pose.position.x == pytest.approx(4)


def test_a_frame_that_is_no_link_and_tags_that_are_missing(bench, caplog):
    # conforms: libgazebo_ros_p3d.so/frameName, libgazebo_ros_p3d.so/bodyName
    # conforms: libgazebo_ros_p3d.so/topicName
    body, topic = "<bodyName>hand</bodyName>", "<topicName>t</topicName>"
    for tags, said in ((body + topic + "<frameName>nope</frameName>", "named 'nope'"),
                       (topic, "it needs a <bodyName>"), (body, "it needs a <topicName>")):
        caplog.clear()
        bench.spawn(arm("p3d", tags))
        assert said in caplog.text
        bench.delete("arm")


def test_tf_prefix_of_p3d_is_exactly_in_its_namespace(bench):
    # conforms: tf_prefix of sensors
    bench.graph.parameters.update({"/tf_prefix": "top", "/r2/tf_prefix": "own"})
    frames = []
    for namespace in ("r1", "r2"):
        bench.spawn(arm("p3d", f"""<bodyName>hand</bodyName><topicName>t</topicName>
          <robotNamespace>{namespace}</robotNamespace>""", "true"))
        poses = bench.listen(f"/{namespace}/t")
        bench.run(0.001)
        frames.append((poses[0].header.frame_id, poses[0].child_frame_id))
        bench.delete("arm")
    assert frames == [("world", "hand"), ("own/world", "hand")]


def test_noise_and_rate_of_p3d(bench):
    # conforms: libgazebo_ros_p3d.so/gaussianNoise, libgazebo_ros_p3d.so/updateRate
    tags = """<bodyName>hand</bodyName><topicName>t</topicName><gaussianNoise>0.1</gaussianNoise>
      <updateRate>300</updateRate>"""
    bench.spawn(arm("p3d", tags, "true"))
    poses = bench.listen("/t")
    bench.run(1.0)
    assert len(poses) == 250  # every 4 steps of 1 ms
    rates = np.array([xyz(p.twist.twist.linear) + xyz(p.twist.twist.angular) for p in poses])
    assert rates.std(axis=0) == pytest.approx([0.1] * 6, rel=0.15)
    assert len({p.pose.pose.position.x for p in poses}) == 1  # the pose is exact
    assert poses[0].pose.covariance[7] == poses[0].twist.covariance[35] == pytest.approx(0.01)


def test_joint_states(bench, caplog):
    # conforms: libgazebo_ros_joint_state_publisher.so
    # conforms: libgazebo_ros_joint_state_publisher.so/jointName
    # conforms: libgazebo_ros_joint_state_publisher.so/updateRate
    tags = "<jointName> weld,\n hinge , nope</jointName><updateRate>30</updateRate>"
    model = bench.spawn(arm("joint_state_publisher", tags), Pose((0, 0, 9)))
    model.joint("hinge").reset(0.5, 0.25)
    assert "named 'nope'" in caplog.text
    states = bench.listen("/arm/joint_states")
    bench.run(1.0)
    assert [round(state.header.stamp.to_sec() * 1000) for state in states[:3]] == [34, 67, 100]
    first = states[0]
    assert isinstance(first, JointState)
    assert (first.name, first.effort) == (["weld", "hinge"], [])
    assert first.position == pytest.approx([0, 0.5 + 0.25 * 0.034], abs=1e-3)
    assert first.velocity == pytest.approx([0, 0.25], abs=1e-2)


@pytest.mark.parametrize("tag, topic", [
    ("", "/arm/joint_states"), ("<robotNamespace/>", "/arm/joint_states"),
    ("<robotNamespace>/</robotNamespace>", "/joint_states")])
def test_namespace_and_emptiness_of_joint_states(bench, tag, topic):
    # conforms: libgazebo_ros_joint_state_publisher.so/robotNamespace
    # conforms: libgazebo_ros_joint_state_publisher.so/jointName
    # conforms: libgazebo_ros_joint_state_publisher.so/updateRate
    bench.spawn(arm("joint_state_publisher", tag))
    states = bench.listen(topic)
    bench.run(0.1)
    assert [state.name for state in states] == [[]] * 10
