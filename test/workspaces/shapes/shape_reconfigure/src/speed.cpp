#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>
#include <shape_reconfigure/SpeedConfig.h>

void change(shape_reconfigure::SpeedConfig& config, uint32_t) { ROS_INFO("speed %.2f", config.speed); }

int main(int argc, char** argv) {
  ros::init(argc, argv, "shape_speed_cpp");
  dynamic_reconfigure::Server<shape_reconfigure::SpeedConfig> server;
  server.setCallback(change);
  ros::spin();
  return 0;
}
