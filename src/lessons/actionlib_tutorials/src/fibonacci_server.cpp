// An action server: a number of the Fibonacci sequence each second.  动作服务端：每秒算一个数。
#include <string>

#include <actionlib/server/simple_action_server.h>
#include <actionlib_tutorials/FibonacciAction.h>
#include <ros/ros.h>

class Fibonacci {
 public:
  explicit Fibonacci(const std::string& name)
      : name_(name),
        server_(node_, name, [this](const actionlib_tutorials::FibonacciGoalConstPtr& goal) { execute(goal); },
                false) {
    server_.start();
  }

 private:
  // Runs in its own thread, for one goal at a time.  每次只执行一个目标
  void execute(const actionlib_tutorials::FibonacciGoalConstPtr& goal) {
    actionlib_tutorials::FibonacciFeedback progress;
    auto& sequence = progress.sequence;
    sequence = {0, 1};
    ROS_INFO("%s: Executing, creating fibonacci sequence of order %i with seeds %i, %i", name_.c_str(), goal->order,
             sequence[0], sequence[1]);
    ros::Rate rate(1);
    for (int i = 1; i <= goal->order; ++i) {
      // Cancelled, or another goal has come.  被取消，或来了新目标
      if (server_.isPreemptRequested() || !ros::ok()) {
        ROS_INFO("%s: Preempted", name_.c_str());
        server_.setPreempted();
        return;
      }
      sequence.push_back(sequence[i] + sequence[i - 1]);
      server_.publishFeedback(progress);
      rate.sleep();
    }
    actionlib_tutorials::FibonacciResult result;
    result.sequence = sequence;
    ROS_INFO("%s: Succeeded", name_.c_str());
    server_.setSucceeded(result);
  }

  ros::NodeHandle node_;
  std::string name_;
  actionlib::SimpleActionServer<actionlib_tutorials::FibonacciAction> server_;
};

int main(int argc, char** argv) {
  ros::init(argc, argv, "fibonacci");
  Fibonacci fibonacci("fibonacci");
  ros::spin();
}
