// Reads, sets, deletes and looks for parameters.  读写、删除和查找参数。
#include <string>

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "parameters");
  ros::NodeHandle node;
  std::string text;
  if (node.getParam("my_param", text)) {
    ROS_INFO("Got param: %s", text.c_str());
  } else {
    ROS_ERROR("Failed to get param 'my_param'");  // rosparam set /my_param hello  先设置它
  }
  int number = node.param("my_num", 42);  // 42 if there is none  没有就是 42
  ROS_INFO("my_num is %d", number);
  node.setParam("my_param", "hello there");
  node.deleteParam("my_param");
  if (!node.hasParam("my_param")) ROS_INFO("No param named 'my_param'");
  std::string key;
  // From this namespace upwards.  从当前命名空间逐级向上查找
  if (!node.searchParam("b", key)) ROS_INFO("No param 'b' found in an upward search");
}
