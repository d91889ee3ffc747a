#include "turtlebot3_fake/turtlebot3_fake.h"

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf/transform_broadcaster.h>
#include <turtlebot3_msgs/SensorState.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "turtlebot3_fake_node");
  ros::NodeHandle node;
  ros::Publisher odometry = node.advertise<nav_msgs::Odometry>(kOdomFrame, 10);
  tf::TransformBroadcaster broadcaster;
  ros::spin();
  return 0;
}
