"""ros_control's side of the joints: controllers by type, the manager, and its services.

They follow controller_manager/src/controller_manager.cpp, and the robot's joints
gazebo_ros_control/src/default_robot_hw_sim.cpp.
"""
