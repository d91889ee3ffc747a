"""libgazebo_ros_hand_of_god.so: a link follows a tf frame, and its pose is published."""

import rospy
import tf2_ros
from tf2_msgs.msg import TFMessage

from bullet_sim.errors import PluginError
from bullet_sim.mechanisms.spring_damper import SpringDamper
from bullet_sim.pose import Pose
from bullet_sim_ros import convert
from bullet_sim_ros.plugin_host import PluginContext, plugin

WORLD = "world"


@plugin("libgazebo_ros_hand_of_god.so")
class HandOfGodPlugin:
    """Pulls the link towards FRAME_desired in `world`; while tf has that, sends FRAME_actual."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        self._link = context.model.link(p.required("linkName"))
        stiffness, angular = p.number("kl", 200.0), p.number("ka", 200.0)
        if stiffness < 0 or angular < 0:
            raise PluginError(f"<kl> is {stiffness:g} and <ka> {angular:g}; a spring is not "
                              "less than 0")
        frame = p.text("frameId", "hog")
        self._desired, self._actual = f"{frame}_desired", f"{frame}_actual"
        self._hand = SpringDamper(context.world, self._link, stiffness, angular)
        self._frames = tf2_ros.BufferCore(rospy.Duration(10))
        context.host.announce_transforms()
        context.subscribe("/tf", TFMessage, self._take, queue_size=100)
        context.subscribe("/tf_static", TFMessage, self._take_static, queue_size=100)
        self._hand.update(None)  # for the first step
        context.each_step(self._pull)
        context.on_reset(self._frames.clear)

    def _take(self, msg: TFMessage) -> None:
        for transform in msg.transforms:
            self._frames.set_transform(transform, "tf")

    def _take_static(self, msg: TFMessage) -> None:
        for transform in msg.transforms:
            self._frames.set_transform_static(transform, "tf_static")

    def _wanted(self) -> Pose | None:
        try:
            found = self._frames.lookup_transform_core(WORLD, self._desired, rospy.Time(0))
        except tf2_ros.TransformException:
            return None
        return Pose(convert.triple(found.transform.translation),
                    convert.quaternion_from_msg(found.transform.rotation))

    def _pull(self) -> None:
        wanted = self._wanted()
        self._hand.update(wanted)
        host = self._context.host
        if wanted is not None and host.transforms_wanted():
            host.send_transforms([convert.transform_to_msg(
                self._link.pose, self._context.world.time, WORLD, self._actual)])
