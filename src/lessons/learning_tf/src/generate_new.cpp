// Follow, 1 of 3: spawn a second turtle.  跟随（一）：生成第二只海龟。
#include <ros/ros.h>
#include <turtlesim/Spawn.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "generate_new");
  ros::NodeHandle node;
  ros::service::waitForService("/spawn");
  turtlesim::Spawn spawn;
  spawn.request.x = 1.0;  // m
  spawn.request.y = 1.0;
  spawn.request.theta = 3.14;  // rad
  spawn.request.name = "turtle2";
  if (ros::service::call("/spawn", spawn)) {
    ROS_INFO("spawned: %s", spawn.response.name.c_str());
  } else {
    ROS_ERROR("no turtle: is there a %s already?  是否已有同名海龟？", spawn.request.name.c_str());
    return 1;
  }
}
