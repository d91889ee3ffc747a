#include <ros/ros.h>
#include <sensor_msgs/Imu.h>

ros::Publisher flat;

void on_imu(sensor_msgs::Imu imu) {
  imu.linear_acceleration.x = imu.linear_acceleration.y = 0.0;
  flat.publish(imu);
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "flat_world_imu_node");
  ros::NodeHandle node;
  flat = node.advertise<sensor_msgs::Imu>("imu_out", 10);
  ros::Subscriber subscriber = node.subscribe("imu_in", 10, on_imu);
  ros::spin();
  return 0;
}
