"""The services of /gazebo: each handler runs in the loop, and turns an exception into a status.

"Upstream" is gazebo_ros/src/gazebo_ros_api_plugin.cpp, in the function of the service's name.
"""

import rospy

from bullet_sim.formats import Resources
from bullet_sim_ros.services.forces import offer_force_services
from bullet_sim_ros.services.joints import offer_joint_services
from bullet_sim_ros.services.lights import offer_light_services
from bullet_sim_ros.services.links import offer_link_services
from bullet_sim_ros.services.models import offer_model_services
from bullet_sim_ros.services.physics import offer_physics_services
from bullet_sim_ros.services.physics_reconfigure import PhysicsReconfigure
from bullet_sim_ros.services.states import offer_state_services
from bullet_sim_ros.services.worlds import offer_world_services
from bullet_sim_ros.simulation import Simulation


def offer_services(simulation: Simulation, resources: Resources) -> None:
    """All of them."""
    offer_model_services(simulation, resources)
    offer_state_services(simulation)
    offer_link_services(simulation)
    offer_joint_services(simulation)
    offer_light_services(simulation)
    offer_world_services(simulation)
    offer_force_services(simulation)
    offer_physics_services(simulation)
    PhysicsReconfigure(simulation)
    rospy.loginfo("Finished loading Gazebo ROS API Plugin.")
