"""Read the messages in test_bag.  读出 test_bag 里的消息。"""

import sys

from rclpy.serialization import deserialize_message
from rosbag2_py import ConverterOptions, SequentialReader, StorageFilter, StorageOptions
from std_msgs.msg import String

FOLDER = "test_bag"  # unless another is named  也可在命令行指定
TOPIC = "chatter"


def main():
    bag = SequentialReader()
    folder = (sys.argv[1:] or [FOLDER])[0]
    try:
        bag.open(StorageOptions(uri=folder, storage_id="mcap"), ConverterOptions("cdr", "cdr"))
    except RuntimeError as error:
        sys.exit(f"read_bag.py: {error}: run write_bag.py here first")
    bag.set_filter(StorageFilter(topics=[TOPIC]))
    while bag.has_next():
        # The time at which the message was written, in ns.  时间是写入的时刻
        topic, data, time = bag.read_next()
        print(f"{time * 1e-9:.3f} {topic}: {deserialize_message(data, String).data}")


if __name__ == "__main__":
    main()
