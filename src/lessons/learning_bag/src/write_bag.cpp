// Write three messages to test.bag.  把三条消息写入 test.bag。
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include <string>

const std::string FILE_NAME = "test.bag";  // in the current folder; overwritten  写在当前目录，会覆盖
const std::string TOPIC = "chatter";

int main(int argc, char** argv) {
  ros::init(argc, argv, "write_bag");
  ros::NodeHandle node;
  rosbag::Bag bag(FILE_NAME, rosbag::bagmode::Write);
  for (int count = 0; count < 3; ++count) {
    std_msgs::String message;
    message.data = "hello " + std::to_string(count);
    bag.write(TOPIC, ros::Time::now(), message);
  }
  bag.close();  // writes the index; without it a bag cannot be read  不关闭则没有索引
  ROS_INFO("wrote 3 messages on %s to %s", TOPIC.c_str(), FILE_NAME.c_str());
}
