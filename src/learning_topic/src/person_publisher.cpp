// Publish messages of a custom type.  发布自定义消息。
#include <learning_topic/Person.h>  // generated from msg/Person.msg  由 msg/Person.msg 生成
#include <ros/ros.h>

const double RATE_HZ = 10;

int main(int argc, char** argv) {
  ros::init(argc, argv, "person_publisher", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<learning_topic::Person>("/person_info", 10);
  learning_topic::Person person;
  person.name = "Tom";
  person.age = 18;
  person.sex = learning_topic::Person::male;
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    publisher.publish(person);
    ROS_INFO("published: %s, age %d, sex %d", person.name.c_str(), person.age, person.sex);
    rate.sleep();
  }
}
