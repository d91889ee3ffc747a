#include <ros/ros.h>
#include <shape_cpp/doubled.h>
#include <shape_msgs/Reading.h>
#include <shape_msgs/Scale.h>

bool scale(shape_msgs::Scale::Request& request, shape_msgs::Scale::Response& response) {
  response.scaled = doubled(request.value);
  return true;
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "shape_talker");
  ros::NodeHandle node;
  ros::Publisher readings = node.advertise<shape_msgs::Reading>("reading", 10);
  ros::ServiceServer server = node.advertiseService("scale", scale);
  ros::Rate rate(20);
  while (ros::ok()) {
    shape_msgs::Reading reading;
    reading.value = doubled(21.0);
    readings.publish(reading);
    ros::spinOnce();
    rate.sleep();
  }
  return 0;
}
