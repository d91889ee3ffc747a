"""The services of /gazebo: each handler runs in the loop, and turns an exception into a status.

They follow gazebo_ros/src/gazebo_ros_api_plugin.cpp, in which the function of set_link_state is
setLinkState and so on.
"""

import rospy

from bullet_sim_ros.services import forces, joints, lights, links, models, states, worlds
from bullet_sim_ros.services.answers import offer_registered
from bullet_sim_ros.services.physics import PhysicsReconfigure
from bullet_sim_ros.simulation import Simulation

__all__ = ["forces", "joints", "lights", "links", "models", "offer_services", "states", "worlds"]


def offer_services(simulation: Simulation) -> None:
    """Advertise all services of /gazebo."""
    offer_registered(simulation)
    PhysicsReconfigure(simulation)
    rospy.loginfo("Finished loading Gazebo ROS API Plugin.")
