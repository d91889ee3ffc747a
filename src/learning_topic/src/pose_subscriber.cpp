// Read the turtle's pose.  订阅海龟的位姿。
#include <ros/ros.h>
#include <turtlesim/Pose.h>

void poseCallback(const turtlesim::Pose& pose) {
  ROS_INFO("turtle at x: %.3f, y: %.3f", pose.x, pose.y);
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "pose_subscriber", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  // The subscription lasts as long as this object.  对象销毁时订阅随之取消
  ros::Subscriber subscriber = node.subscribe("/turtle1/pose", 10, poseCallback);
  ros::spin();  // runs the callbacks until Ctrl-C  循环执行回调函数
}
