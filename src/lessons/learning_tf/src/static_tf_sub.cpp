// Transform a point that the radar sees into world.  把雷达坐标系里的点变换到 world。
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>  // lets tf2 transform a point  让 tf2 认识点消息
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

const double RATE_HZ = 1;

int main(int argc, char** argv) {
  ros::init(argc, argv, "static_tf_sub");
  ros::NodeHandle node;
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);  // fills the buffer  接收变换并放进 buffer
  geometry_msgs::PointStamped seen;
  seen.header.frame_id = "radar";
  seen.point.x = 10.0;  // m
  seen.point.y = 2.0;
  seen.point.z = 3.0;
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    try {
      geometry_msgs::Point point = buffer.transform(seen, "world").point;
      ROS_INFO("in world: %.2f, %.2f, %.2f", point.x, point.y, point.z);
    } catch (const tf2::TransformException& error) {
      ROS_WARN_THROTTLE(10.0, "not yet: %s", error.what());
    }
    rate.sleep();
  }
}
