// Follow, 3 of 3: turtle2 drives towards turtle1.  跟随（三）：turtle2 追 turtle1。
#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>

const double RATE_HZ = 10;
const double DRIVE_GAIN = 0.5;  // m/s per m of distance
const double TURN_GAIN = 4.0;   // rad/s per rad of bearing
const ros::Duration WAIT(3.0);  // for the frames, at the start  开始时等待坐标变换

int main(int argc, char** argv) {
  ros::init(argc, argv, "demo04_sub");
  ros::NodeHandle node;
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("/turtle2/cmd_vel", 1);
  ros::Rate rate(RATE_HZ);
  while (ros::ok()) {
    try {
      // turtle1 in the frame of turtle2: x ahead, y to the left.  turtle1 在 turtle2 坐标系中的位置
      geometry_msgs::Vector3 target =
          buffer.lookupTransform("turtle2", "turtle1", ros::Time(0), WAIT).transform.translation;
      geometry_msgs::Twist command;
      command.linear.x = DRIVE_GAIN * std::hypot(target.x, target.y);
      command.angular.z = TURN_GAIN * std::atan2(target.y, target.x);
      publisher.publish(command);
    } catch (const tf2::TransformException& error) {
      ROS_WARN_THROTTLE(10.0, "not yet: %s", error.what());
    }
    rate.sleep();
  }
}
