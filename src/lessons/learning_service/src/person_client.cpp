// Call a service of a custom type.  调用自定义类型的服务。
#include <learning_service/Person.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "person_client");
  ros::NodeHandle node;
  ROS_INFO("waiting for /show_person");
  ros::service::waitForService("/show_person");  // until the server is running  等待服务端启动
  ros::ServiceClient client = node.serviceClient<learning_service::Person>("/show_person");
  learning_service::Person person;
  person.request.name = "Tom";
  person.request.age = 20;
  // The constants are part of the request, above the three dashes.  常量在请求部分定义
  person.request.sex = learning_service::Person::Request::male;
  if (client.call(person)) {
    ROS_INFO("show_person answers: %s", person.response.result.c_str());
  } else {
    ROS_ERROR("no answer from /show_person");
  }
}
