#include <cstdio>
#include <kobuki_msgs/BumperEvent.h>

int main() { std::printf("centre %d\n", kobuki_msgs::BumperEvent::CENTER); }
