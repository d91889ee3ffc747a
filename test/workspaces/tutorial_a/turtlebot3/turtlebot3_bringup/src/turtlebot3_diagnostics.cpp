#include <diagnostic_msgs/DiagnosticArray.h>
#include <turtlebot3_msgs/SensorState.h>

int main() {
  diagnostic_msgs::DiagnosticArray diagnostics;
  turtlebot3_msgs::SensorState state;
  return diagnostics.status.size() + state.battery;
}
