// Two timers: every 0.1 s and every second.  两个定时器：0.1 秒和 1 秒。
#include <ros/ros.h>

void often(const ros::TimerEvent&) { ROS_INFO("Callback 1 triggered"); }

void seldom(const ros::TimerEvent&) { ROS_INFO("Callback 2 triggered"); }

int main(int argc, char** argv) {
  ros::init(argc, argv, "timers");
  ros::NodeHandle node;
  ros::Timer first = node.createTimer(ros::Duration(0.1), often);
  ros::Timer second = node.createTimer(ros::Duration(1.0), seldom);
  ros::spin();
}
