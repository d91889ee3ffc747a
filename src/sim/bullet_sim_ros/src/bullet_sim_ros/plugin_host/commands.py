"""The commands of a drive: geometry_msgs/Twist on a topic."""

from collections.abc import Callable

from geometry_msgs.msg import Twist

from bullet_sim_ros import names
from bullet_sim_ros.plugin_host.context import PluginContext


def subscribe_commands(context: PluginContext, namespace: str, topic: str,
                       command: Callable[[Twist], None], queue_size: int = 1) -> None:
    """Subscribe, and call `command(message)` in the loop; refuses messages with bad numbers."""
    def take(message: Twist) -> Callable[[], None] | None:
        return None if context.refuses("command", message) else lambda: command(message)

    context.subscribe(names.join(namespace, topic), Twist, take, queue_size=queue_size,
                      tcp_nodelay=True)
