#include <interactive_markers/interactive_marker_server.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "turtlebot3_marker_server");
  interactive_markers::InteractiveMarkerServer server("turtlebot3_marker_server");
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = "base_footprint";
  marker.name = "turtlebot3_marker";
  server.insert(marker);
  server.applyChanges();
  ros::spin();
  return 0;
}
