"""rviz/Image: a picture beside the view, by the page's own stream of pictures (images.py)."""

from sim_viewer.rviz.display_type import DisplayType, Drawer

TYPE = DisplayType(
    "rviz/Image", Drawer, messages=("sensor_msgs/Image", "sensor_msgs/CompressedImage"),
    topic="/camera/rgb/image_raw", topic_key="Image Topic")
