// Read the messages in test.bag.  读出 test.bag 里的消息。
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <iostream>
#include <string>

const std::string FILE_NAME = "test.bag";
const std::string TOPIC = "chatter";

int main(int argc, char** argv) {
  ros::init(argc, argv, "read_bag");
  ros::NodeHandle node;
  try {
    rosbag::Bag bag(FILE_NAME, rosbag::bagmode::Read);
    for (const rosbag::MessageInstance& found : rosbag::View(bag, rosbag::TopicQuery(TOPIC))) {
      // Null if the message has another type.  类型不符时为空指针
      std_msgs::String::ConstPtr message = found.instantiate<std_msgs::String>();
      // The time at which the message was written.  时间是写入的时刻
      if (message) ROS_INFO("%.3f %s: %s", found.getTime().toSec(), TOPIC.c_str(), message->data.c_str());
    }
  } catch (const rosbag::BagException& error) {
    std::cerr << "read_bag: " << error.what() << ": run write_bag here first  请先运行 write_bag\n";
    return 1;
  }
}
