// Call a service: turtlesim spawns a second turtle.  调用服务，再生成一只海龟。
#include <ros/ros.h>
#include <turtlesim/Spawn.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "turtle_spawn");
  ros::NodeHandle node;
  ROS_INFO("waiting for /spawn");
  ros::service::waitForService("/spawn");  // until turtlesim is running  等待 turtlesim 启动
  ros::ServiceClient client = node.serviceClient<turtlesim::Spawn>("/spawn");
  turtlesim::Spawn spawn;  // holds request and response  请求和应答都在里面
  spawn.request.x = 2.0;   // m
  spawn.request.y = 2.0;
  spawn.request.theta = 0.0;  // rad
  spawn.request.name = "turtle2";
  if (client.call(spawn)) {
    ROS_INFO("spawned: %s", spawn.response.name.c_str());
  } else {
    ROS_ERROR("no turtle: is there a %s already?  是否已有同名海龟？", spawn.request.name.c_str());
    return 1;
  }
}
