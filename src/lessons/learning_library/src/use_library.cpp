// Use your own header and library.  使用自己的头文件和库。
#include <learning_library/describe.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "use_library");
  ros::NodeHandle node;
  learning_topic::Person person;
  person.name = "Tom";
  person.age = 18;
  person.sex = learning_topic::Person::male;
  ROS_INFO("%s", learning_library::describe(person).c_str());
}
