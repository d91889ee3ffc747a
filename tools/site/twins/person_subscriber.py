import rclpy
from learning_topic_interfaces.msg import Person  # a package of its own, built by ament_cmake


def person_callback(msg):
    node.get_logger().info(f"received: {msg.name}, age {msg.age}, sex {msg.sex}")


rclpy.init()
node = rclpy.create_node("person_subscriber")
node.create_subscription(Person, "/person_info", person_callback, 10)
rclpy.spin(node)
