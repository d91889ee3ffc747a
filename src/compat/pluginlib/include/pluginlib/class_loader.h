// The name that this header has in ROS 1, where it brings in the log macros.
#pragma once
#include <pluginlib/class_loader.hpp>
#include <ros/console.h>
