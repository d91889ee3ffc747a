import rclpy
from turtlesim.srv import Spawn

rclpy.init()
node = rclpy.create_node("turtle_spawn")
client = node.create_client(Spawn, "/spawn")
while not client.wait_for_service(timeout_sec=1.0):
    node.get_logger().info("waiting for /spawn")
future = client.call_async(Spawn.Request(x=2.0, y=2.0, theta=0.0, name="turtle2"))
rclpy.spin_until_future_complete(node, future)
node.get_logger().info(f"spawned: {future.result().name}")
