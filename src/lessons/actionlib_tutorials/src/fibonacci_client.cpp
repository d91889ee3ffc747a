// An action client: asks for 20 Fibonacci numbers.  动作客户端：要二十个斐波那契数。
#include <actionlib/client/simple_action_client.h>
#include <actionlib_tutorials/FibonacciAction.h>
#include <ros/ros.h>

const int ORDER = 20;
const double PATIENCE = 30;  // s

int main(int argc, char** argv) {
  ros::init(argc, argv, "test_fibonacci");
  // true: a thread of its own handles what the server sends  由单独的线程处理回复
  actionlib::SimpleActionClient<actionlib_tutorials::FibonacciAction> client("fibonacci", true);
  ROS_INFO("Waiting for action server to start.");
  client.waitForServer();
  ROS_INFO("Action server started, sending goal.");
  actionlib_tutorials::FibonacciGoal goal;
  goal.order = ORDER;
  client.sendGoal(goal);
  if (client.waitForResult(ros::Duration(PATIENCE))) {
    ROS_INFO("Action finished: %s", client.getState().toString().c_str());
  } else {
    ROS_INFO("Action did not finish before the time out.");
  }
}
