"""Write three messages to the bag test_bag.  把三条消息写入 test_bag。"""

import sys

import rclpy
from rclpy.serialization import serialize_message
from rosbag2_py import ConverterOptions, SequentialWriter, StorageOptions, TopicMetadata
from std_msgs.msg import String

FOLDER = "test_bag"  # a bag is a folder; it must not exist yet  bag 是文件夹，不能已存在
TOPIC = "chatter"


def main():
    rclpy.init()
    node = rclpy.create_node("write_bag")
    bag = SequentialWriter()
    try:
        bag.open(StorageOptions(uri=FOLDER, storage_id="mcap"), ConverterOptions("", ""))
    except RuntimeError as error:
        sys.exit(f"write_bag.py: {error}: run it in a folder of your own")
    bag.create_topic(TopicMetadata(
        id=0, name=TOPIC, type="std_msgs/msg/String", serialization_format="cdr"))
    for count in range(3):
        message = String(data=f"hello {count}")
        bag.write(TOPIC, serialize_message(message), node.get_clock().now().nanoseconds)
    node.get_logger().info(f"wrote 3 messages on {TOPIC} to {FOLDER}")


if __name__ == "__main__":
    main()
