#include <ros/ros.h>
#include <tf/transform_broadcaster.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "shape_broadcaster");
  ros::NodeHandle node;
  tf::TransformBroadcaster broadcaster;
  tf::Transform transform(tf::Quaternion(0, 0, 0, 1), tf::Vector3(1, 2, 3));
  ros::Rate rate(20);
  while (ros::ok()) {
    broadcaster.sendTransform(tf::StampedTransform(transform, ros::Time::now(), "world", "shape"));
    rate.sleep();
  }
  return 0;
}
