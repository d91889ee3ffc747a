// Transform from one child frame to another, through their parent.  在两个子坐标系之间变换。
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>  // lets tf2 transform a point  让 tf2 认识点消息
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

const double RATE_HZ = 1;

int main(int argc, char** argv) {
  ros::init(argc, argv, "multi_tf_sub");
  ros::NodeHandle node;
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  geometry_msgs::PointStamped in_son1;
  in_son1.header.frame_id = "son1";
  in_son1.point.x = 1.0;  // m
  in_son1.point.y = 2.0;
  in_son1.point.z = 3.0;
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    try {
      // son1 in the frame of son2: target first, source second.  先目标，后源
      geometry_msgs::Vector3 origin =
          buffer.lookupTransform("son2", "son1", ros::Time(0)).transform.translation;
      ROS_INFO("son1 in son2: %.2f, %.2f, %.2f", origin.x, origin.y, origin.z);
      geometry_msgs::Point point = buffer.transform(in_son1, "son2").point;
      ROS_INFO("the point in son2: %.2f, %.2f, %.2f", point.x, point.y, point.z);
    } catch (const tf2::TransformException& error) {
      ROS_WARN_THROTTLE(10.0, "not yet: %s", error.what());
    }
    rate.sleep();
  }
}
