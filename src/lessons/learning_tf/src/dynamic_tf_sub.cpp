// Where is the point one metre ahead of the turtle?  海龟正前方一米的点在 world 的哪里？
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>  // lets tf2 transform a point  让 tf2 认识点消息
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

const double RATE_HZ = 1;

int main(int argc, char** argv) {
  ros::init(argc, argv, "dynamic_tf_sub");
  ros::NodeHandle node;
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  geometry_msgs::PointStamped ahead;
  ahead.header.frame_id = "turtle1";
  ahead.header.stamp = ros::Time(0);  // 0: the latest available transform  0 表示最新的变换
  ahead.point.x = 1.0;                // m
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    try {
      geometry_msgs::Point point = buffer.transform(ahead, "world").point;
      ROS_INFO("in world: %.2f, %.2f", point.x, point.y);
    } catch (const tf2::TransformException& error) {
      ROS_WARN_THROTTLE(10.0, "not yet: %s", error.what());
    }
    rate.sleep();
  }
}
