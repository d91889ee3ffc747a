"""~scene: the scene as text, for the web page and other programs that draw."""

import rospy
from std_msgs.msg import String

from bullet_sim.pose import Pose
from bullet_sim.rendering.scene_text import scene_to_text
from bullet_sim.world import World
from bullet_sim_ros import names


class SceneTopic:
    """Latched; sent while subscribed to, and again when links, visuals or lights change.

    Motion is in link_states; in a paused world, which publishes none, a new text is sent instead.
    """

    def __init__(self, world: World):
        self._world = world
        self._publisher = rospy.Publisher(names.SCENE, String, queue_size=1, latch=True)
        self._sent_version: int | None = None  # version of the scene
        self._still: tuple[Pose, ...] = ()  # of all links, while paused

    def update(self) -> None:
        """Called in each turn of the loop, paused or not: costs little while nothing changes."""
        if not self._publisher.get_num_connections():
            return
        still = self._poses() if self._world.paused else self._still
        if self._sent_version == self._world.scene.version and still == self._still:
            return
        self._sent_version, self._still = self._world.scene.version, still
        self._publisher.publish(String(scene_to_text(self._world.update_scene())))

    def _poses(self) -> tuple[Pose, ...]:
        return tuple(link.pose for model in self._world.models.values()
                     for link in model.links.values())
