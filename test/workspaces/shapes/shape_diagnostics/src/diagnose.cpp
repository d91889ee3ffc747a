#include <angles/angles.h>
#include <diagnostic_msgs/DiagnosticStatus.h>
#include <cstdio>

int main() {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = "shape";
  std::printf("%.3f\n", angles::normalize_angle(2 * M_PI + 0.5));
  return 0;
}
