"""The plugins of hector_gazebo_plugins.

"Upstream" is the file of the library's name in its src, gazebo_ros_imu.cpp and so on; the errors
are those of its include/hector_gazebo_plugins/sensor_model.h and update_timer.h.
"""
