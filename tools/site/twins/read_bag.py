from rclpy.serialization import deserialize_message
from rosbag2_py import ConverterOptions, SequentialReader, StorageOptions
from std_msgs.msg import String

bag = SequentialReader()
bag.open(StorageOptions(uri="test_bag", storage_id="mcap"), ConverterOptions("cdr", "cdr"))
while bag.has_next():
    topic, data, nanoseconds = bag.read_next()
    print(f"{nanoseconds * 1e-9:.3f} {topic}: {deserialize_message(data, String).data}")
