// An action client with a thread of its own: averages 100 numbers.  动作客户端：求一百个数的平均值。
#include <thread>

#include <actionlib/client/simple_action_client.h>
#include <actionlib_tutorials/AveragingAction.h>
#include <ros/ros.h>

const int SAMPLES = 100;
const double PATIENCE = 30;  // s

int main(int argc, char** argv) {
  ros::init(argc, argv, "test_averaging");
  actionlib::SimpleActionClient<actionlib_tutorials::AveragingAction> client("averaging", false);
  std::thread spinning([] { ros::spin(); });  // handles what the server sends  处理服务端的回复
  ROS_INFO("Waiting for action server to start.");
  client.waitForServer();
  ROS_INFO("Action server started, sending goal.");
  actionlib_tutorials::AveragingGoal goal;
  goal.samples = SAMPLES;
  client.sendGoal(goal);
  if (client.waitForResult(ros::Duration(PATIENCE))) {
    ROS_INFO("Action finished: %s", client.getState().toString().c_str());
  } else {
    ROS_INFO("Action did not finish before the time out.");
  }
  ros::shutdown();
  spinning.join();
}
