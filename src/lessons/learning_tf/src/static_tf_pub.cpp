// Publish a static frame: where the radar is mounted.  发布静态坐标变换。
#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "static_tf_pub");
  ros::NodeHandle node;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = "world";  // parent  父坐标系
  transform.child_frame_id = "radar";  // child  子坐标系
  transform.transform.translation.x = 0.2;  // m
  transform.transform.translation.y = 0.0;
  transform.transform.translation.z = 0.5;
  transform.transform.rotation.w = 1.0;  // no rotation; all zeros would be invalid  不能全为零
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(transform);
  ROS_INFO("world -> radar: 0.2 0.0 0.5");
  ros::spin();  // latched: later listeners get it too, while this node runs  节点须保持运行
}
