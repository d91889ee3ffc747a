// Passes on what the talker said, and uses a message of gazebo_msgs in C++.
#include <gazebo_msgs/ModelStates.h>
#include <ros/ros.h>
#include <shape_msgs/Reading.h>
#include <std_msgs/Float64.h>

ros::Publisher heard;

void on_reading(const shape_msgs::Reading::ConstPtr& reading) {
  std_msgs::Float64 message;
  message.data = reading->value;
  heard.publish(message);
}

void on_states(const gazebo_msgs::ModelStates::ConstPtr& states) {
  ROS_INFO_ONCE("%zu models", states->name.size());
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "shape_listener");
  ros::NodeHandle node;
  heard = node.advertise<std_msgs::Float64>("heard_cpp", 10);
  ros::Subscriber readings = node.subscribe("reading", 10, on_reading);
  ros::Subscriber states = node.subscribe("/gazebo/model_states", 1, on_states);
  ros::spin();
  return 0;
}
