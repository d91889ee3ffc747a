"""rviz/Image: an image beside the view, from the page's own image stream (images.py)."""

from sim_viewer.rviz.display_type import DisplayType, Drawer, View
from sim_viewer.rviz.drawing import Part


class Picture(Drawer):
    """Draws nothing in the view."""

    def draw(self, view: View) -> list[Part]:
        return []


TYPE = DisplayType(
    "rviz/Image", Picture, messages=("sensor_msgs/Image", "sensor_msgs/CompressedImage"),
    topic="/camera/rgb/image_raw", topic_key="Image Topic")
