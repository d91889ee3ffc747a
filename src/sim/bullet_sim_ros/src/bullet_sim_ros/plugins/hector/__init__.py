"""The plugins of hector_gazebo_plugins, and hector_quadrotor_gazebo_plugins' barometer.

C++ files named here are in their src and include; sensor errors follow sensor_model.h, rates
update_timer.h.
"""
