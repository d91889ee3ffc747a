// Drives straight on; upstream's also avoids obstacles.
#include "turtlebot3_gazebo/turtlebot3_drive.h"

#include <geometry_msgs/Twist.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "turtlebot3_drive");
  ros::NodeHandle node;
  ros::Publisher command = node.advertise<geometry_msgs::Twist>("cmd_vel", 10);
  geometry_msgs::Twist twist;
  twist.linear.x = kLinear;
  ros::Rate rate(10);
  while (ros::ok()) {
    command.publish(twist);
    ros::spinOnce();
    rate.sleep();
  }
  return 0;
}
