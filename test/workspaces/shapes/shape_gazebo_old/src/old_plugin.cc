#include <gazebo_plugins/gazebo_ros_utils.h>
