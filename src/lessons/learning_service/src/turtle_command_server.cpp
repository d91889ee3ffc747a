// A service that starts and stops the turtle.  服务端：用服务让海龟走或停。
#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

const double SPEED = 0.5;  // m/s
const double TURN = 0.2;   // rad/s
const double RATE_HZ = 10;
bool driving = false;

// Runs once for each call, within spinOnce.  每次调用在 spinOnce 中执行一次
bool commandCallback(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  driving = !driving;
  ROS_INFO("publish velocity: %s", driving ? "yes" : "no");
  response.success = true;
  response.message = "Change turtle command state!";
  return true;  // false: the call fails  返回 false 表示调用失败
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "turtle_command_server");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("/turtle1/cmd_vel", 10);
  ros::ServiceServer server = node.advertiseService("/turtle_command", commandCallback);
  ROS_INFO("ready for /turtle_command");
  geometry_msgs::Twist command;
  command.linear.x = SPEED;
  command.angular.z = TURN;
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    ros::spinOnce();
    if (driving) publisher.publish(command);
    rate.sleep();
  }
}
