"""What /gazebo publishes about models, links and its own monitor."""

import pytest
import rospy
from geometry_msgs.msg import Twist

from bullet_sim.pose import Pose
from bullet_sim_ros import loop

ARM = """<model name="arm"><link name="base"/><link name="tip"><pose>0 0 1 0 0 0</pose></link>
  <joint name="root" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="hinge" type="revolute"><parent>base</parent><child>tip</child>
    <axis><xyz>0 0 1</xyz></axis></joint>
  <model name="tool"><link name="blade"/></model></model>"""


def test_state_topics_while_somebody_listens_and_time_runs(make_bench):
    # conforms: /gazebo/model_states, /gazebo/model_states/name, /gazebo/model_states/pose
    # conforms: /gazebo/model_states/twist, /gazebo/link_states, /gazebo/link_states/name
    # conforms: /gazebo/link_states/pose, /gazebo/link_states/twist, ~pub_state_frequency
    bench = make_bench(pub_state_frequency=50.0)
    arm = bench.spawn(ARM, Pose((0, 0, 5)))
    models, links = bench.listen("/gazebo/model_states"), bench.listen("/gazebo/link_states")
    arm.joint("hinge").reset(0.0, 2.0)
    bench.run(0.1)
    assert (len(models), len(links)) == (5, 5)
    assert models[0].name == ["ground_plane", "arm"] and isinstance(models[0].twist[0], Twist)
    assert models[0].pose[1].position.z == pytest.approx(5)
    assert links[0].name == ["ground_plane::link", "arm::base", "arm::tip"]  # none of nested ones
    assert links[0].pose[2].position.z == pytest.approx(6)
    assert links[0].twist[2].angular.z == pytest.approx(2, rel=0.01)
    bench.call("/gazebo/pause_physics")
    bench.simulation.mailbox.post(bench.simulation.stop)
    loop.run(bench.simulation)
    assert (len(models), len(links)) == (5, 5)


def test_state_topics_at_every_step_if_wanted(make_bench):
    # conforms: ~pub_state_frequency
    bench = make_bench(pub_state_frequency=0.0)
    models = bench.listen("/gazebo/model_states")
    bench.run(0.02)
    assert len(models) == 20


def test_performance(bench, monkeypatch):
    # conforms: /gazebo/performance_metrics, /gazebo/performance_metrics/header
    # conforms: /gazebo/performance_metrics/real_time_factor
    # conforms: /gazebo/performance_metrics/sensors
    bench.spawn("""<model name="m"><link name="l"><sensor name="eye" type="ray">
      <update_rate>10</update_rate><ray><scan><horizontal><samples>3</samples></horizontal></scan>
      <range><min>0.1</min><max>1</max></range></ray><plugin name="p"
      filename="libgazebo_ros_laser.so"><topicName>scan</topicName></plugin></sensor></link>
      </model>""")
    bench.run(0.5)
    monitor = bench.simulation.real_time_factor
    monkeypatch.setattr(monitor, "update", lambda *_now: None)  # it would measure
    monitor.measured = 0.75
    metrics = bench.listen("/gazebo/performance_metrics")
    bench.run(0.5)
    message = metrics[0]
    assert message.header.stamp > rospy.Time(0, 500_000_000)
    assert message.real_time_factor == 0.75
    assert [(sensor.name, sensor.fps) for sensor in message.sensors] == [("eye", -1.0)]
