"""ros_control: controllers by type, the controller manager and its services.

These follow controller_manager/src/controller_manager.cpp; the robot's joints follow
gazebo_ros_control/src/default_robot_hw_sim.cpp.
"""
