"""The plugins of hector_gazebo_plugins, and hector_quadrotor_gazebo_plugins' barometer.

Files named here are those of their src and include; the errors are those of sensor_model.h, the
rates those of update_timer.h.
"""
