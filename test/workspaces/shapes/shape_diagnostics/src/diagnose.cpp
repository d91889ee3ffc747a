#include <angles/angles.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <interactive_markers/interactive_marker_server.h>
#include <ros/ros.h>
#include <cstdio>

int main() {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = "shape";
  std::printf("%.3f\n", angles::normalize_angle(2 * M_PI + 0.5));
  return 0;
}
