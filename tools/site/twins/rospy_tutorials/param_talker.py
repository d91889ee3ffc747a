"""Reads and sets parameters, and publishes one of them.  读写参数，并发布其中一个。

    ros2 run rospy_tutorials param_talker.py --ros-args -p utterance:="Hello" -p gains.P:=1.5

There is no server for all: each parameter belongs to a node and is declared there; a value of
another type is refused.  没有公共的参数服务器：参数属于节点，要先声明；类型不对会被拒绝。
"""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String

GAINS = {"P": 1.0, "I": 0.1, "D": 0.0}


class ParamTalker(Node):
    def __init__(self):
        super().__init__("param_talker")
        self.declare_parameter("utterance", "Hello World")
        topic = self.declare_parameter("topic_name", "chatter").value
        # A group is a prefix of names.  一组参数是名字的前缀
        self.declare_parameters("gains", list(GAINS.items()))
        gains = {name: each.value for name, each in self.get_parameters_by_prefix("gains").items()}
        self.get_logger().info(f"gains are {gains['P']}, {gains['I']}, {gains['D']}")
        self.declare_parameter("list_of_floats", [1.0, 2.0, 3.0, 4.0])
        self.declare_parameter("to_delete", "baz")
        self.set_parameters([Parameter("list_of_floats", value=[4.0, 3.0])])
        self.undeclare_parameter("to_delete")
        self.publisher = self.create_publisher(String, topic, 10)
        self.create_timer(1.0, self.speak)  # s

    def speak(self):
        utterance = self.get_parameter("utterance").value  # ros2 param set changes it at any time
        self.publisher.publish(String(data=utterance))
        self.get_logger().info(utterance)


def main():
    rclpy.init()
    rclpy.spin(ParamTalker())


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C
