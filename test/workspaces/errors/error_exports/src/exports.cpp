#include <cstdio>
#include <tf2_ros/buffer.h>

int main()
{
  tf2_ros::Buffer buffer;
  buffer.setUsingDedicatedThread(true);
  std::printf("exports %d\n", static_cast<int>(ros::isInitialized()));
}
