// Make turtlesim's background white: read and set parameters.  读写参数，改背景色。
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <iostream>
#include <string>
#include <vector>

const int WHITE = 255;
// Private parameters of the node /turtlesim, so below its name.  节点 /turtlesim 的私有参数
const std::vector<std::string> NAMES = {
    "/turtlesim/background_r", "/turtlesim/background_g", "/turtlesim/background_b"};

bool showBackground() {
  std::vector<int> values;
  for (const std::string& name : NAMES) {
    int value;
    if (!ros::param::get(name, value) && ros::param::has(name)) {  // of another type  类型不对
      std::cerr << "parameter_config: parameter " << name << " must be a whole number; type: "
                << "rosparam set " << name << " 255  应为整数\n";
      return false;
    }
    if (!ros::param::has(name)) {
      std::cerr << "parameter_config: no parameter '" << name << "': turtlesim sets it as it "
                << "starts; end it if it runs, and type rosrun turtlesim turtlesim_node  "
                << "请启动（或重启）turtlesim\n";
      return false;
    }
    values.push_back(value);
  }
  ROS_INFO("background: r %d, g %d, b %d", values[0], values[1], values[2]);
  return true;
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "parameter_config");
  ros::NodeHandle node;
  if (!showBackground()) return 1;
  for (const std::string& name : NAMES) ros::param::set(name, WHITE);
  showBackground();
  // Nodes decide when to read parameters: turtlesim on /clear.  调用 /clear 后才重新读取
  ros::service::waitForService("/clear");
  std_srvs::Empty clear;
  if (!ros::service::call("/clear", clear)) ROS_ERROR("turtlesim did not clear its background");
}
