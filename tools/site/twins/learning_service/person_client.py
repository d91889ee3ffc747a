"""Call a service of a custom type.  调用自定义类型的服务。"""

import rclpy
from learning_service_interfaces.srv import Person
from rclpy.executors import ExternalShutdownException


def main():
    rclpy.init()
    node = rclpy.create_node("person_client")
    client = node.create_client(Person, "/show_person")
    while not client.wait_for_service(timeout_sec=1.0):  # until the server is running  等待服务端
        node.get_logger().info("waiting for /show_person")
    # Constants are upper case in ROS 2.  ROS 2 的常量用大写
    request = Person.Request(name="Tom", age=20, sex=Person.Request.MALE)
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future)
    node.get_logger().info(f"show_person answers: {future.result().result}")


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
