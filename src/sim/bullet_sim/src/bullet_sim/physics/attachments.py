"""Welds made while the world runs: of two links, or of a link to a place in the world."""

from __future__ import annotations

from bullet_sim.physics.body import Body
from bullet_sim.physics.quiet import pybullet
from bullet_sim.pose import IDENTITY, Pose

WORLD_BODY = -1  # PyBullet's number of what is no body
STRONGEST = 1e6  # N and N m: more than anything that hangs on a robot


class Attachment:
    """Holds a link as it is now, seen from another one or from the world, until `release`."""

    def __init__(self, body: Body, link: str, other: Body | None = None, other_link: str = ""):
        self._client = client = body.client
        self._bodies = [body] if other is None else [body, other]
        index, pose = body.centre(link)
        other_number, other_index, other_pose = WORLD_BODY, -1, IDENTITY
        if other is not None:
            other_number = other.number
            other_index, other_pose = other.centre(other_link)
        self._pose = pose
        held = other_pose.inverse() * pose
        self._number: int | None = client.call(
            pybullet.createConstraint, body.number, index, other_number, other_index,
            pybullet.JOINT_FIXED, (0, 0, 0), (0, 0, 0), held.position, (0, 0, 0, 1),
            held.orientation)
        client.call(pybullet.changeConstraint, self._number, maxForce=STRONGEST)
        for each in self._bodies:
            each.on_unload.append(self.release)

    def shift(self, change: Pose) -> None:
        """Of a link held in the world: move where it is held by a displacement in the world."""
        self._pose = change * self._pose
        self._client.call(pybullet.changeConstraint, self._number,
                          jointChildPivot=self._pose.position,
                          jointChildFrameOrientation=self._pose.orientation, maxForce=STRONGEST)

    def release(self) -> None:
        """Let go; a second time does nothing."""
        if self._number is None:
            return
        self._client.call(pybullet.removeConstraint, self._number)
        self._number = None
        for each in self._bodies:
            each.on_unload.remove(self.release)
