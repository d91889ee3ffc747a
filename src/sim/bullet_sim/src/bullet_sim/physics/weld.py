"""Welds made while the world runs: between two links, or of a link to the world."""

from bullet_sim.physics.body import Body, fasten
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Pose

WORLD_BODY = -1  # PyBullet's number for no body
STRONGEST = 1e6  # N and N m: more than any load of a robot


class Weld:
    """Holds a link at its current pose relative to another one or the world, until `release`.

    It outlives a body's rebuild. The engine's constraint connects centres of mass, which a rebuild
    may move; therefore the pose of the link's own frame is kept.
    """

    def __init__(self, body: Body, link: str, other: Body | None = None, other_link: str = ""):
        self._body, self._link = body, link
        self._other, self._other_link = other, other_link
        self.bodies = [body] if other in (None, body) else [body, other]
        self._pose_holder_link = self._present_pose()
        self._constraint: int | None = None
        fasten(self)

    def _present_pose(self) -> Pose:
        """Pose of the link's frame relative to the holder."""
        pose = self._body.links.frame(self._link)
        if self._other is None:
            return pose
        return self._other.links.frame(self._other_link).inverse() * pose

    def renew(self) -> None:
        """Hold the link at its current pose, after it or its holder was moved."""
        self.detach()
        self._pose_holder_link = self._present_pose()
        self.attach()

    def attach(self) -> None:
        """Create the constraint, if both bodies are loaded."""
        if self._constraint is not None or not all(each.is_loaded for each in self.bodies):
            return
        held = self._held()
        index = self._body.links.index[self._link]
        holder = ((WORLD_BODY, -1) if self._other is None else
                  (self._other.number, self._other.links.index[self._other_link]))
        client = self._body.client
        self._constraint = client.change(
            pybullet.createConstraint, self._body.number, index, *holder, pybullet.JOINT_FIXED,
            (0, 0, 0), (0, 0, 0), held.position, (0, 0, 0, 1), held.orientation)
        client.change(pybullet.changeConstraint, self._constraint, maxForce=STRONGEST)

    def detach(self) -> None:
        """Remove the constraint; `attach` creates it again."""
        if self._constraint is None:
            return
        constraint, self._constraint = self._constraint, None
        self._body.client.change(pybullet.removeConstraint, constraint)

    def _held(self) -> Pose:
        """Pose at which the link's centre of mass is held: relative to the holder's, or world."""
        index = self._body.links.index[self._link]
        held = self._pose_holder_link * self._body.links.com_in_link(index)
        if self._other is None:
            return held
        com = self._other.links.com_in_link(self._other.links.index[self._other_link])
        return com.inverse() * held

    def shift(self, change: Pose) -> None:
        """For a link held in the world: move its holding pose by a displacement in the world."""
        self._pose_holder_link = change * self._pose_holder_link
        if self._constraint is None:
            return
        held = self._held()
        self._body.client.change(
            pybullet.changeConstraint, self._constraint, jointChildPivot=held.position,
            jointChildFrameOrientation=held.orientation, maxForce=STRONGEST)

    def release(self) -> None:
        """Release the link; a second call does nothing."""
        self.detach()
        for each in self.bodies:
            if self in each.attached:
                each.attached.remove(self)
