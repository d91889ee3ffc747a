// Says hello on /chatter ten times a second.  每秒十次在 /chatter 上发布一句话。
#include <sstream>

#include <ros/ros.h>
#include <std_msgs/String.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "talker");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<std_msgs::String>("chatter", 1000);
  ros::Rate rate(10);
  for (int count = 0; ros::ok(); ++count) {
    std::stringstream text;
    text << "hello world " << count;
    std_msgs::String message;
    message.data = text.str();
    ROS_INFO("%s", message.data.c_str());
    publisher.publish(message);
    ros::spinOnce();
    rate.sleep();
  }
}
