// A listener whose callback is a method.  用类的成员函数做回调。
#include <ros/ros.h>
#include <std_msgs/String.h>

class Listener {
 public:
  void heard(const std_msgs::String::ConstPtr& message) {
    ROS_INFO("I heard: [%s]", message->data.c_str());
  }
};

int main(int argc, char** argv) {
  ros::init(argc, argv, "listener_class");
  ros::NodeHandle node;
  Listener listener;  // must live as long as the subscriber  生存期不能短于订阅者
  ros::Subscriber subscriber = node.subscribe("chatter", 1000, &Listener::heard, &listener);
  ros::spin();
}
