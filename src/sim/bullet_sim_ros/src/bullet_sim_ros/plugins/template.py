"""libgazebo_ros_template.so: an example to copy from; it loads and does nothing."""

from bullet_sim_ros.plugin_host import PluginContext, plugin


@plugin("libgazebo_ros_template.so")
class TemplatePlugin:
    """In a model or in the world."""

    def __init__(self, context: PluginContext):
        del context
