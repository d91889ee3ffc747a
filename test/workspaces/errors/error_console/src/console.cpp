#include <pluginlib/class_loader.h>

void say() { ROS_INFO("said"); }
