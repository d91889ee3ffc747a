// Follow, 2 of 3: publish world -> the given turtle.  跟随（二）：发布某只海龟的坐标。
#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>
#include <turtlesim/Pose.h>

#include <cmath>
#include <iostream>
#include <string>

std::string turtle;

void poseCallback(const turtlesim::Pose& pose) {
  static tf2_ros::TransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = "world";
  transform.child_frame_id = turtle;
  transform.transform.translation.x = pose.x;
  transform.transform.translation.y = pose.y;
  transform.transform.rotation.z = std::sin(pose.theta / 2);
  transform.transform.rotation.w = std::cos(pose.theta / 2);
  broadcaster.sendTransform(transform);
}

int main(int argc, char** argv) {
  // Removes roslaunch's __name:= from argv. One node per turtle.  去掉 roslaunch 加的参数
  ros::init(argc, argv, "demo04_pub", ros::init_options::AnonymousName);
  if (argc != 2) {
    std::cerr << "demo04_pub: which turtle? rosrun learning_tf demo04_pub turtle1\n";
    return 1;
  }
  turtle = argv[1];
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("/" + turtle + "/pose", 1, poseCallback);
  ros::spin();
}
