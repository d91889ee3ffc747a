#include <sensor_msgs/Imu.h>

int main() {
  sensor_msgs::Imu imu;
  imu.linear_acceleration.x = imu.linear_acceleration.y = 0.0;
  return 0;
}
