// Publish a moving frame: the turtle's pose, over and over.  发布动态坐标变换。
#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>
#include <turtlesim/Pose.h>

#include <cmath>

void poseCallback(const turtlesim::Pose& pose) {
  static tf2_ros::TransformBroadcaster broadcaster;  // created once  只创建一次
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = "world";
  transform.child_frame_id = "turtle1";
  transform.transform.translation.x = pose.x;
  transform.transform.translation.y = pose.y;
  // A rotation by theta about z, as a quaternion.  绕 z 轴转 theta 的四元数
  transform.transform.rotation.z = std::sin(pose.theta / 2);
  transform.transform.rotation.w = std::cos(pose.theta / 2);
  broadcaster.sendTransform(transform);
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "dynamic_tf_pub");
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe("/turtle1/pose", 1, poseCallback);
  ros::spin();
}
