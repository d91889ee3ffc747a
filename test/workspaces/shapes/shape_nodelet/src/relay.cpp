#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.h>
#include <ros/ros.h>
#include <shape_msgs/Reading.h>
#include <std_msgs/Float64.h>

namespace shape_nodelet {

class Relay : public nodelet::Nodelet {
  void onInit() override {
    publisher_ = getNodeHandle().advertise<std_msgs::Float64>("heard_nodelet", 10);
    subscriber_ = getNodeHandle().subscribe("reading", 10, &Relay::on_reading, this);
  }
  void on_reading(const shape_msgs::Reading::ConstPtr& reading) {
    std_msgs::Float64 message;
    message.data = reading->value;
    publisher_.publish(message);
  }
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace shape_nodelet

PLUGINLIB_EXPORT_CLASS(shape_nodelet::Relay, nodelet::Nodelet)
