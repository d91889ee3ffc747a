"""Gazebo's topics and services of the node /gazebo."""

import rospy

from bullet_sim.formats import Resources
from bullet_sim_ros.metrics import MetricsTopic
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.scene_topic import SceneTopic
from bullet_sim_ros.services import offer_services
from bullet_sim_ros.simulation import Simulation
from bullet_sim_ros.state_topics import StateTopics


def open_network(simulation: Simulation, resources: Resources, parameters: NodeParameters) -> None:
    """All of them, unless the parameter `~enable_ros_network` is false."""
    if not parameters.enable_ros_network:
        rospy.loginfo("ROS gazebo topics/services are disabled")
        return
    StateTopics(simulation, parameters.pub_state_frequency)
    MetricsTopic(simulation)
    simulation.each_turn.append(SceneTopic(simulation.world).update)
    offer_services(simulation, resources)
