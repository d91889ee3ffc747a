// Prints what is said on /chatter.  打印 /chatter 上的每一句话。
#include <ros/ros.h>
#include <std_msgs/String.h>

// Runs once for each message, within spin.  每条消息在 spin 中执行一次
void heard(const std_msgs::String::ConstPtr& message) {
  ROS_INFO("I heard: [%s]", message->data.c_str());
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "listener");
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("chatter", 1000, heard);
  ros::spin();
}
