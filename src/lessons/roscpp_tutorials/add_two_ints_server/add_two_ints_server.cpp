// A service that adds two integers.  把两个整数相加的服务。
#include <ros/ros.h>
#include <roscpp_tutorials/TwoInts.h>

bool add(roscpp_tutorials::TwoInts::Request& request,
         roscpp_tutorials::TwoInts::Response& response) {
  response.sum = request.a + request.b;
  ROS_INFO("request: x=%ld, y=%ld", static_cast<long>(request.a), static_cast<long>(request.b));
  ROS_INFO("  sending back response: [%ld]", static_cast<long>(response.sum));
  return true;  // false: the call fails  返回 false 表示调用失败
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "add_two_ints_server");
  ros::NodeHandle node;
  ros::ServiceServer server = node.advertiseService("add_two_ints", add);
  ROS_INFO("Ready to add two ints.");
  ros::spin();
}
