// Has two integers added: add_two_ints_client X Y.  调用服务，把两个整数相加。
#include <cstdlib>

#include <ros/ros.h>
#include <roscpp_tutorials/TwoInts.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "add_two_ints_client");
  if (argc != 3) {
    ROS_INFO("usage: add_two_ints_client X Y");
    return 1;
  }
  ros::NodeHandle node;
  ros::ServiceClient client = node.serviceClient<roscpp_tutorials::TwoInts>("add_two_ints");
  roscpp_tutorials::TwoInts sum;  // holds request and response  请求和应答都在里面
  sum.request.a = std::atoll(argv[1]);
  sum.request.b = std::atoll(argv[2]);
  if (!client.call(sum)) {
    ROS_ERROR("Failed to call service add_two_ints");
    return 1;
  }
  ROS_INFO("Sum: %ld", static_cast<long>(sum.response.sum));
}
