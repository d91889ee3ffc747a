// Drive the turtle in a circle: publish its velocity.  发布速度，让海龟转圈。
#include <geometry_msgs/Twist.h>
#include <ros/ros.h>

const double SPEED = 0.5;  // m/s
const double TURN = 0.2;   // rad/s
const double RATE_HZ = 10;

int main(int argc, char** argv) {
  ros::init(argc, argv, "velocity_publisher", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("/turtle1/cmd_vel", 10);
  geometry_msgs::Twist command;
  command.linear.x = SPEED;
  command.angular.z = TURN;
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    publisher.publish(command);
    ROS_INFO("velocity: %.2f m/s, %.2f rad/s", command.linear.x, command.angular.z);
    rate.sleep();
  }
}
