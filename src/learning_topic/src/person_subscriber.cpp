// Receive messages of a custom type.  订阅自定义消息。
#include <learning_topic/Person.h>
#include <ros/ros.h>

void personCallback(const learning_topic::Person& person) {
  ROS_INFO("received: %s, age %d, sex %d", person.name.c_str(), person.age, person.sex);
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "person_subscriber", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("/person_info", 10, personCallback);
  ros::spin();
}
