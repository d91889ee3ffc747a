"""One window as an image topic of the running ROS node, if there is one."""

import logging
import sys
import threading

from terminal_language import translated

from headless_highgui.pixels import to_msg

log = logging.getLogger(__name__)


def running_rospy():
    """The rospy module once its node is initialised, else None; never imports it itself."""
    rospy = sys.modules.get("rospy")
    return rospy if rospy is not None and rospy.core.is_initialized() else None


class WindowTopic:
    """Publishes on ~windows/<label>; converts a picture only when somebody looks."""

    def __init__(self, label):
        self.label = label
        self.image = None  # the last one shown, not copied
        self.publisher = None
        # rospy serialises for all and for a new subscriber into one buffer, the latter unlocked.
        self._sending = threading.Lock()

    def show(self, image):
        self.image = image
        rospy = running_rospy()
        if rospy is None or rospy.is_shutdown():
            return
        if self.publisher is None:
            self._open(rospy)
        if self.publisher.get_num_connections() > 0:
            try:
                with self._sending:
                    self.publisher.publish(to_msg(image, rospy.Time.now()))
            except rospy.ROSException:
                log.debug("the node closed %s while it was published", self.label)

    def close(self):
        if self.publisher is not None:
            self.publisher.unregister()
            self.publisher = None

    def peer_subscribe(self, _topic_name, _publish, publish_to_new):
        """rospy calls this for each new subscriber: it sees the last picture at once."""
        if self.image is not None:
            with self._sending:
                publish_to_new(to_msg(self.image, running_rospy().Time.now()))

    def peer_unsubscribe(self, _topic_name, _remaining):
        """Part of what rospy asks of a listener; nothing to do."""

    def _open(self, rospy):
        from sensor_msgs.msg import Image

        self.publisher = rospy.Publisher(
            f"~windows/{self.label}", Image, subscriber_listener=self, queue_size=1
        )
        rospy.loginfo(translated(
            f"no screen: the window is the image topic {self.publisher.resolved_name}"))
