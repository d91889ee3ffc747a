"""Welds made while the world runs: of two links, or of a link to a place in the world."""

from bullet_sim.physics.body import Body, fasten
from bullet_sim.physics.quiet import pybullet
from bullet_sim.pose import Pose

WORLD_BODY = -1  # PyBullet's number of what is no body
STRONGEST = 1e6  # N and N m: more than any load of a robot


class Weld:
    """Holds a link as it is now, seen from another one or from the world, until `release`.

    It outlives a body's rebuild. The engine's constraint ties centres of mass, which a rebuild may
    move; what is kept is therefore the pose of the link's own frame.
    """

    def __init__(self, body: Body, link: str, other: Body | None = None, other_link: str = ""):
        self._body, self._link = body, link
        self._other, self._other_link = other, other_link
        self.bodies = [body] if other in (None, body) else [body, other]
        self._pose_holder_link = self._present_pose()
        self._constraint: int | None = None
        fasten(self)

    def _present_pose(self) -> Pose:
        """Of the link's frame, seen from what holds it."""
        pose = self._body.engine_frame(self._body.index[self._link])
        if self._other is None:
            return pose
        return self._other.engine_frame(self._other.index[self._other_link]).inverse() * pose

    def renew(self) -> None:
        """Hold the link as it is now, after it or its holder was put elsewhere."""
        self.detach()
        self._pose_holder_link = self._present_pose()
        self.attach()

    def attach(self) -> None:
        """Put the constraint in, if both bodies are there."""
        if self._constraint is not None or not all(each.is_loaded for each in self.bodies):
            return
        held = self._held()
        index = self._body.index[self._link]
        holder = ((WORLD_BODY, -1) if self._other is None else
                  (self._other.number, self._other.index[self._other_link]))
        client = self._body.client
        self._constraint = client.change(
            pybullet.createConstraint, self._body.number, index, *holder, pybullet.JOINT_FIXED,
            (0, 0, 0), (0, 0, 0), held.position, (0, 0, 0, 1), held.orientation)
        client.change(pybullet.changeConstraint, self._constraint, maxForce=STRONGEST)

    def detach(self) -> None:
        """Remove the constraint; `attach` makes it again."""
        if self._constraint is None:
            return
        constraint, self._constraint = self._constraint, None
        self._body.client.change(pybullet.removeConstraint, constraint)

    def _held(self) -> Pose:
        """Where the link's centre of mass is held: seen from the holder's, or in the world."""
        held = self._pose_holder_link * self._body.com_in_link(self._body.index[self._link])
        if self._other is None:
            return held
        com = self._other.com_in_link(self._other.index[self._other_link])
        return com.inverse() * held

    def shift(self, change: Pose) -> None:
        """Of a link held in the world: move where it is held by a displacement in the world."""
        self._pose_holder_link = change * self._pose_holder_link
        if self._constraint is None:
            return
        held = self._held()
        self._body.client.change(
            pybullet.changeConstraint, self._constraint, jointChildPivot=held.position,
            jointChildFrameOrientation=held.orientation, maxForce=STRONGEST)

    def release(self) -> None:
        """Let go; a second time does nothing."""
        self.detach()
        for each in self.bodies:
            if self in each.attached:
                each.attached.remove(self)
