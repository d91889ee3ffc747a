import rclpy
from learning_action_interfaces.action import AddInts
from rclpy.action import ActionClient


def feedback_callback(message):
    node.get_logger().info(f"progress: {message.feedback.progress_bar * 100:.0f} %")


rclpy.init()
node = rclpy.create_node("action_client")
client = ActionClient(node, AddInts, "addInts")
client.wait_for_server()
accepted = client.send_goal_async(AddInts.Goal(num=10), feedback_callback)
rclpy.spin_until_future_complete(node, accepted)
result = accepted.result().get_result_async()
rclpy.spin_until_future_complete(node, result)
node.get_logger().info(f"result {result.result().result.result}")
