// Provide a service of a custom type.  提供自定义类型的服务。
#include <learning_service/Person.h>
#include <ros/ros.h>

bool personCallback(learning_service::Person::Request& request,
                    learning_service::Person::Response& response) {
  ROS_INFO("person: %s, age %d, sex %d", request.name.c_str(), request.age, request.sex);
  response.result = "OK";  // what the client gets  客户端收到的结果
  return true;
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "person_server");
  ros::NodeHandle node;
  ros::ServiceServer server = node.advertiseService("/show_person", personCallback);
  ROS_INFO("ready for /show_person");
  ros::spin();
}
