"""What plugins are written against: context, tags, registry, and output that several share.

It does for them what gazebo_plugins/include/gazebo_plugins/gazebo_ros_utils.h does.
"""
