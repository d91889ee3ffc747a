#include "turtlebot3_fake/turtlebot3_fake.h"

#include <nav_msgs/Odometry.h>
#include <turtlebot3_msgs/SensorState.h>

int main() {
  nav_msgs::Odometry odometry;
  odometry.header.frame_id = kOdomFrame;
  turtlebot3_msgs::SensorState state;
  return state.battery;
}
