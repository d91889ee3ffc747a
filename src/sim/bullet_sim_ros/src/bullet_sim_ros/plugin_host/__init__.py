"""What plugins are written against: context, tags, registry, and output that several share.

"Upstream" is gazebo_plugins/include/gazebo_plugins/gazebo_ros_utils.h and the plugins that use it.
"""
