"""libgazebo_ros_projector.so: its topics, without the light."""

import logging

from std_msgs.msg import Int32, String

from bullet_sim_ros import names
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")


@plugin("libgazebo_ros_projector.so")
class ProjectorPlugin:
    """Subscribes to the topics, so that publishers find a subscriber; the light is not rendered."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        namespace = p.namespace(missing="/", empty="/")
        for tag, kind in (("textureTopicName", String), ("projectorTopicName", Int32)):
            topic = p.text(tag)
            if topic:
                context.subscribe(names.join(namespace, topic), kind, lambda _message: None,
                                  queue_size=1)
        log.warning("%s: topics are there, but light of projector %s is not drawn",
                    context.describe(), p.text("projector", "(no name)"))
