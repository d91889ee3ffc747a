#include <ros/time.h>
#include <cstdio>
int main() {
  std::printf("beside the plugin %.1f\n", ros::Duration(1.0).toSec());
  return 0;
}
