// The name that this header has in ROS 1.
#pragma once
#include <pluginlib/class_list_macros.hpp>
