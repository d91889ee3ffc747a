"""Objects shared by all plugins of one simulation: world, loop, drawing thread and /tf."""

import tf2_ros
from geometry_msgs.msg import TransformStamped

from bullet_sim.world import World
from bullet_sim_ros.drawing import DrawingThread
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.scheduler import Scheduler
from bullet_sim_ros.topic_faults import Senders


class PluginHost:
    """Objects shared by all plugins of one simulation."""

    def __init__(self, world: World, mailbox: Mailbox, scheduler: Scheduler, drawing: DrawingThread,
                 lockstep: Lockstep):
        self.world = world
        self.mailbox = mailbox
        self.scheduler = scheduler
        self.drawing = drawing
        self.lockstep = lockstep
        self.senders = Senders()
        self.warned: set[tuple[str, str]] = set()  # unknown plugins: model, file name
        self._broadcaster: tf2_ros.TransformBroadcaster | None = None

    def announce_transforms(self) -> None:
        """Advertise /tf, so that early subscribers miss nothing."""
        if self._broadcaster is None:
            self._broadcaster = tf2_ros.TransformBroadcaster()

    def send_transforms(self, transforms: list[TransformStamped]) -> None:
        """Publish on /tf, after `announce_transforms`."""
        self._broadcaster.sendTransform(transforms)

    def transforms_wanted(self) -> bool:
        """Whether anybody listens to /tf."""
        return bool(self._broadcaster and self._broadcaster.pub_tf.get_num_connections())
