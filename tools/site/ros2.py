"""The page "from this course to ROS 2", with a text for rclpy of each lesson that it has."""

from __future__ import annotations

import re

from staging import HERE, ROOT, Pages

LESSONS = ROOT / "src/learning_topic/scripts"
MAIN = '''def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # Ctrl-C stays Python's own
    follower = Follower(){timer}
    try:
        rclpy.spin(follower)
    except KeyboardInterrupt:
        {end}


if __name__ == "__main__":
    main()
'''
# What speaks to ROS in the followers, and its like in rclpy.
RULES = [(re.compile(old), new) for old, new in (
    (r"import rospy\n", "import rclpy\n"),
    (r"(from sensor_msgs.msg import Image\n)", r"from rclpy.node import Node\n"
     r"from rclpy.qos import qos_profile_sensor_data\nfrom rclpy.signals import "
     r"SignalHandlerOptions\nfrom rclpy.time import Time\n\1"),
    (r"class Follower:\n    def __init__\(self\):\n",
     'class Follower(Node):\n    def __init__(self):\n        super().__init__("follower")\n'),
    (r'rospy\.Publisher\("(\w+)", (\w+), queue_size=1\)', r'self.create_publisher(\2, "\1", 1)'),
    (r'rospy\.Subscriber\(\s*("[\w/]+"), Image, (\S+), queue_size=1, buff_size=2\*\*24\s*\)',
     r"self.create_subscription(\n            Image, \1, \2, qos_profile_sensor_data)"),
    (r'CAMERA \| rospy\.get_param\("~camera", \{\}\)',
     r'{name: self.declare_parameter(f"camera.{name}", value).value'
     r"\n                       for name, value in CAMERA.items()}"),
    # rclpy refuses a value of another type than the default's by itself.
    (r"def number\(name, default\):\n(?:    .*\n)+\n\n|import sys\n", ""),
    (r'\bnumber\("(\w+)", (\w+)\)', r'self.declare_parameter("\1", \2).value'),
    (r'rospy\.get_param\("~(\w+)", (\w+)\)', r'self.declare_parameter("\1", \2).value'),
    (r'rospy\.logwarn_throttle\(2, (".*?")\)',
     r"self.get_logger().warning(\1, throttle_duration_sec=2.0)"),
    (r"rospy\.get_time\(\)", "self.get_clock().now().nanoseconds * 1e-9"),
    (r"msg\.header\.stamp\.to_sec\(\)", "Time.from_msg(msg.header.stamp).nanoseconds * 1e-9"),
    (r"self\.image_sub\.unregister\(\)", "self.destroy_subscription(self.image_sub)"),
    (r"check_images\(self, _event\)", "check_images(self)"))]
FIRST = '''import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image


def image_callback(msg):
    """Called once for each image."""


rclpy.init()
node = rclpy.create_node("follower")
node.create_subscription(
    Image, "camera/rgb/image_raw", image_callback, qos_profile_sensor_data)
rclpy.spin(node)
'''


def follower(source: str) -> str:
    """A lesson of learning_topic for rclpy; ValueError if it speaks to ROS in an unknown way."""
    if "class Follower" not in source:
        return FIRST
    timer = "\n    follower.create_timer(0.1, follower.check_images)  # s" * (
        "check_images" in source)
    end = "follower.stop()" if "def stop" in source else "pass"
    text = source[:source.index("def main():")] + MAIN.format(timer=timer, end=end)
    for old, new in RULES:
        text = old.sub(new, text)
    if "Time.from_msg" not in text:
        text = text.replace("from rclpy.time import Time\n", "")
    if "rospy" in text:
        raise ValueError(f"ros2.py: no rule for: {text[text.index('rospy'):].splitlines()[0]}")
    return text


def twins() -> dict[str, str]:
    """All programs for rclpy, by the lesson's file."""
    found = {path.name: follower(path.read_text("utf-8"))
             for path in sorted(LESSONS.glob("0*follower*.py"))}
    return found | {path.name: path.read_text("utf-8")
                    for path in sorted((HERE / "twins").glob("*.py"))}


def add_ros2(pages: Pages) -> None:
    """Add the page."""
    parts = {name: f"### {name}\n\n```python\n{text}```\n" for name, text in twins().items()}
    for language, texts in pages.texts.items():
        text = (HERE / f"ros2.{language}.md").read_text("utf-8")
        for place, ours in (("followers", True), ("twins", False)):
            text = text.replace(f"{{{{{place}}}}}", "\n".join(
                part for name, part in parts.items() if ("follower" in name) is ours))
        texts["docs/ros2.md"] = text
