"""Look-up of tf frames: one tf2 buffer for all pages.

The server looks frames up, not the browser: tf2 interpolates to a message's time or says why it
cannot, a browser would have to be sent some hundred transforms a second, and one buffer is enough
for any number of pages.
"""

from typing import Any

import rospy
import tf2_ros
from tf2_msgs.msg import TFMessage

from bullet_sim.pose import IDENTITY, Pose
from sim_viewer.subscription import SharedSubscription, Subscription
from sim_viewer.tools import names

NANO = 10**9  # ns
JUMP = 2.0  # s; a stamp so much older than the frame's last means that time was reset


class NoPose(ValueError):
    """tf has no transform between two frames, or none at that time; the text is tf's."""


class Subscriptions(list):
    """Several subscriptions that end together."""

    def unregister(self) -> None:
        """End all of them."""
        for one in self:
            one.unregister()


class Transforms(SharedSubscription):
    """Filled while somebody holds it. Thread safe."""

    def __init__(self, node: Any = None):
        super().__init__(node)
        self._forget()

    def subscribe(self) -> Subscriptions:
        """Subscribe, with an empty buffer."""
        self._forget()
        return Subscriptions(Subscription(topic, TFMessage, self._take, static)
                             for topic, static in ((names.TF, False), (names.TF_STATIC, True)))

    def frames(self) -> dict[str, str]:
        """All frames and their parents; a root's is empty."""
        parents = dict(self._parents)
        return dict.fromkeys(set(parents.values()) - set(parents), "") | parents

    def has(self, frame: str) -> bool:
        """Whether there is a transform to or from this frame."""
        return self._buffer._frameExists(frame.lstrip("/"))

    def pose(self, fixed: str, frame: str, stamp: int = 0) -> Pose:
        """The pose of `frame` in `fixed` at a time in ns, 0: the newest. NoPose if unknown."""
        # tf2 has no leading slashes; old tf nodes write them.
        fixed, frame = fixed.lstrip("/"), frame.lstrip("/")
        if frame == fixed:
            return IDENTITY
        try:
            # From ns: Time.from_sec(100.3) is 1 ns early, and tf2 does not extrapolate.
            time = rospy.Time(*divmod(stamp, NANO))
            found = self._buffer.lookup_transform_core(fixed, frame, time)
        except (tf2_ros.TransformException, ValueError, TypeError) as error:
            raise NoPose(str(error)) from None
        place, turn = found.transform.translation, found.transform.rotation
        return Pose((place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w))

    def _forget(self) -> None:
        self._buffer = tf2_ros.BufferCore()
        self._parents: dict[str, str] = {}
        self._newest: dict[str, float] = {}  # s, by child frame

    def _take(self, message: TFMessage, static: bool) -> None:
        buffer = self._buffer
        for one in message.transforms:
            child, stamp = one.child_frame_id.lstrip("/"), one.header.stamp.to_sec()
            if not static and stamp < self._newest.get(child, stamp) - JUMP:
                buffer.clear()  # a simulator was reset or restarted; static transforms stay
                self._newest.clear()
            self._newest[child] = stamp
            self._parents[child] = one.header.frame_id.lstrip("/")
            (buffer.set_transform_static if static else buffer.set_transform)(one, "tf")
