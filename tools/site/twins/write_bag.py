import rclpy
from rclpy.serialization import serialize_message
from rosbag2_py import ConverterOptions, SequentialWriter, StorageOptions, TopicMetadata
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("write_bag")
bag = SequentialWriter()
bag.open(StorageOptions(uri="test_bag", storage_id="mcap"), ConverterOptions("", ""))
bag.create_topic(TopicMetadata(
    id=0, name="chatter", type="std_msgs/msg/String", serialization_format="cdr"))
for count in range(3):
    message = String(data=f"hello {count}")
    bag.write("chatter", serialize_message(message), node.get_clock().now().nanoseconds)
