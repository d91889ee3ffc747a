// An action server that averages what comes on /random_number.  动作服务端：求随机数的平均值。
#include <cmath>
#include <string>

#include <actionlib/server/simple_action_server.h>
#include <actionlib_tutorials/AveragingAction.h>
#include <ros/ros.h>
#include <std_msgs/Float32.h>

const float LEAST_MEAN = 5;  // below it the goal is aborted  平均值小于它就放弃

class Averaging {
 public:
  explicit Averaging(const std::string& name) : name_(name), server_(node_, name, false) {
    server_.registerGoalCallback([this] { accept(); });
    server_.registerPreemptCallback([this] { preempt(); });
    subscriber_ = node_.subscribe("/random_number", 1, &Averaging::take, this);
    server_.start();
  }

 private:
  void accept() {
    progress_ = {};
    sum_ = sum_of_squares_ = 0;
    samples_ = server_.acceptNewGoal()->samples;
  }

  void preempt() {
    ROS_INFO("%s: Preempted", name_.c_str());
    server_.setPreempted();
  }

  // A number has come; the goal ends with the last one.  收到一个数，最后一个结束目标
  void take(const std_msgs::Float32::ConstPtr& number) {
    if (!server_.isActive()) return;
    ++progress_.sample;
    progress_.data = number->data;
    sum_ += number->data;
    sum_of_squares_ += number->data * number->data;
    progress_.mean = sum_ / progress_.sample;
    progress_.std_dev = std::sqrt(std::fabs(sum_of_squares_ / progress_.sample - progress_.mean * progress_.mean));
    server_.publishFeedback(progress_);
    if (progress_.sample > samples_) finish();
  }

  void finish() {
    actionlib_tutorials::AveragingResult result;
    result.mean = progress_.mean;
    result.std_dev = progress_.std_dev;
    if (result.mean < LEAST_MEAN) {
      ROS_INFO("%s: Aborted", name_.c_str());
      server_.setAborted(result);
    } else {
      ROS_INFO("%s: Succeeded", name_.c_str());
      server_.setSucceeded(result);
    }
  }

  ros::NodeHandle node_;
  std::string name_;
  actionlib::SimpleActionServer<actionlib_tutorials::AveragingAction> server_;
  ros::Subscriber subscriber_;
  actionlib_tutorials::AveragingFeedback progress_;
  float sum_ = 0, sum_of_squares_ = 0;
  int samples_ = 0;
};

int main(int argc, char** argv) {
  ros::init(argc, argv, "averaging");
  Averaging averaging(ros::this_node::getName());
  ros::spin();
}
