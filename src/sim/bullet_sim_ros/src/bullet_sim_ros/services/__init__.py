"""The services of /gazebo: each handler runs in the loop, and turns an exception into a status.

They follow gazebo_ros/src/gazebo_ros_api_plugin.cpp, in which the function of set_link_state is
setLinkState and so on.
"""

import rospy

from bullet_sim.formats.resources import Resources
from bullet_sim_ros.services import forces, joints, lights, links, physics, states, worlds
from bullet_sim_ros.services.answers import offer_registered
from bullet_sim_ros.services.models import offer_model_services
from bullet_sim_ros.services.physics_reconfigure import PhysicsReconfigure
from bullet_sim_ros.simulation import Simulation

__all__ = ["forces", "joints", "lights", "links", "offer_services", "physics", "states", "worlds"]


def offer_services(simulation: Simulation, resources: Resources) -> None:
    """Advertise all services of /gazebo."""
    offer_model_services(simulation, resources)
    offer_registered(simulation)
    PhysicsReconfigure(simulation)
    rospy.loginfo("Finished loading Gazebo ROS API Plugin.")
