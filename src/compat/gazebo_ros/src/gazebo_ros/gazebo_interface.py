"""Upstream's Python API: spawn a model or set its joints through the simulator's services."""

import time

import rospy
from gazebo_msgs.msg import *  # noqa: F403  (scripts take message types from this module)
from gazebo_msgs.srv import *  # noqa: F403
from gazebo_msgs.srv import SetModelConfiguration, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Wrench  # noqa: F401

from gazebo_ros.service_wait import wait_for_service

JOINT_DELAY = 1.0  # s, wall time; upstream's answer to its issue 93


def spawn_sdf_model_client(
    model_name, model_xml, robot_namespace, initial_pose, reference_frame, gazebo_namespace
):
    """True or False as the simulator says, None when the service could not be called."""
    return _spawn("sdf", gazebo_namespace, model_name, model_xml, robot_namespace, initial_pose,
                  reference_frame)


def spawn_urdf_model_client(
    model_name, model_xml, robot_namespace, initial_pose, reference_frame, gazebo_namespace
):
    """True or False as the simulator says, None when the service could not be called."""
    return _spawn("urdf", gazebo_namespace, model_name, model_xml, robot_namespace, initial_pose,
                  reference_frame)


def set_model_configuration_client(
    model_name, model_param_name, joint_names, joint_positions, gazebo_namespace
):
    """Puts joints at positions (rad or m); returns as the spawn functions do."""
    service = f"{gazebo_namespace}/set_model_configuration"
    return _call(service, SetModelConfiguration, "Set model configuration status",
                 (model_name, model_param_name, joint_names, joint_positions), JOINT_DELAY)


def _spawn(language, gazebo_namespace, *request):
    service = f"{gazebo_namespace}/spawn_{language}_model"
    return _call(service, SpawnModel, "Spawn status", request)


def _call(service, kind, title, request, delay=0.0):
    rospy.loginfo(f"Waiting for service {service}")
    wait_for_service(service)
    if delay:
        rospy.loginfo(f"Waiting {delay:.0f} s so that the joints are there (upstream issue 93)")
        time.sleep(delay)
    try:
        rospy.loginfo(f"Calling service {service}")
        response = rospy.ServiceProxy(service, kind)(*request)
    except rospy.ServiceException as error:
        print(f"Service call failed: {error}")
        return None
    rospy.loginfo(f"{title}: {response.status_message}")
    return response.success
