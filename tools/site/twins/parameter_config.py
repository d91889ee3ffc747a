import rclpy
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from std_srvs.srv import Empty

rclpy.init()
node = rclpy.create_node("parameter_config")
turtlesim = AsyncParameterClient(node, "turtlesim")  # parameters belong to a node
turtlesim.wait_for_services()
white = [Parameter(f"background_{colour}", value=255) for colour in "rgb"]
rclpy.spin_until_future_complete(node, turtlesim.set_parameters(white))
clear = node.create_client(Empty, "/clear")
clear.wait_for_service()
rclpy.spin_until_future_complete(node, clear.call_async(Empty.Request()))
