#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <turtlebot3_msgs/SensorState.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "turtlebot3_diagnostics");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<diagnostic_msgs::DiagnosticArray>("diagnostics", 10);
  ros::Rate rate(1);
  while (ros::ok()) {
    publisher.publish(diagnostic_msgs::DiagnosticArray());
    rate.sleep();
  }
  return 0;
}
