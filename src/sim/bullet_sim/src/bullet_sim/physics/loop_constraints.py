"""Constraints between links of a model: joints that close a loop, screws' threads and gearboxes."""

import logging
from collections.abc import Iterator

from bullet_sim.description import JointDescription, ModelDescription
from bullet_sim.physics.assembly import WORLD, PhysicsLink
from bullet_sim.physics.axes import TRAVEL
from bullet_sim.physics.body import Body, fasten
from bullet_sim.physics.client import BASE, PhysicsClient
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Pose, Vector3, rotate

log = logging.getLogger(__name__)

STRONGEST = 1e6  # N; with the engine's own limit of 500 a heavy mechanism would come apart
LEVER = 0.1  # m to either side of a hinge's anchor: two fixed points leave one axis to turn
HINGES = ("revolute", "continuous", "screw")
NO_PIVOT = (0.0, 0.0, 0.0)
# Arguments of a constraint: bodies and links, kind, axis, pivots, orientations, further values
Rows = Iterator[tuple[tuple, dict]]


class LoopConstraints:
    """All constraints of one model; made again whenever one of its bodies is."""

    def __init__(self, client: PhysicsClient, model: ModelDescription, bodies: list[Body],
                 loose: list[JointDescription]):
        self._client = client
        self._model = model
        self.bodies = bodies
        self._loose = loose
        self._constraints: list[int] = []
        fasten(self)

    def __bool__(self) -> bool:
        return bool(self._constraints)

    def attach(self) -> None:
        """Create the constraints. KeyError for a joint whose link is in no body."""
        for body in self.bodies:
            for name in body.joints.index:
                if name.endswith(TRAVEL):
                    self._make(*_thread(body, name))
        for joint in self._loose:
            rows = self._gear(joint) if joint.type == "gearbox" else self._loop(joint)
            for row in rows:
                self._make(*row)

    def detach(self) -> None:
        """Remove the constraints."""
        for constraint in self._constraints:
            self._client.change(pybullet.removeConstraint, constraint)
        self._constraints = []

    def _make(self, ends: tuple, change: dict) -> None:
        made = self._client.change(pybullet.createConstraint, *ends)
        self._client.change(pybullet.changeConstraint, made, maxForce=STRONGEST, **change)
        self._constraints.append(made)

    def _place(self, name: str) -> tuple[Body, PhysicsLink]:
        """Body and link of a described link; for the static world, the first fixed body's base."""
        for body in self.bodies:
            if name == WORLD and body.tree.fixed:
                return body, body.tree.links[0]
            for link in body.tree.links:
                if link.name == name:
                    return body, link
        raise KeyError(name)

    def _com_in_model(self, body: Body, link: PhysicsLink) -> Pose:
        index = body.links.index[link.name]
        if index == BASE:
            return body.base_pose_model * body.links.com_in_link(BASE)
        described = next(d for d in self._model.links if d.name == link.described)
        return described.pose * link.offset * body.links.com_in_link(index)

    def _loop(self, joint: JointDescription) -> Rows:
        child = next((link.pose for link in self._model.links if link.name == joint.child), Pose())
        frame = child * joint.pose
        body1, link1 = self._place(joint.parent)
        body2, link2 = self._place(joint.child)
        frames = [self._com_in_model(*place).inverse() * frame
                  for place in ((body1, link1), (body2, link2))]
        ends = (body1.number, body1.links.index[link1.name],
                body2.number, body2.links.index[link2.name])
        if joint.type in ("fixed", "prismatic"):
            kind = pybullet.JOINT_FIXED if joint.type == "fixed" else pybullet.JOINT_PRISMATIC
            yield (*ends, kind, joint.axis, *(f.position for f in frames),
                   *(f.orientation for f in frames)), {}
            return
        for point in _points(joint):
            yield (*ends, pybullet.JOINT_POINT2POINT, NO_PIVOT,
                   *(f.transform(point) for f in frames)), {}

    def _gear(self, joint: JointDescription) -> Rows:
        """Parent and child turn about axes of the reference body: one joint each."""
        sides = [self._seen_from(joint, joint.parent, joint.axis),
                 self._seen_from(joint, joint.child, joint.axis2.axis)]
        if None in sides:
            log.warning(
                "model %s: gearbox %s has no effect: %s and %s must each be held by one revolute "
                "or prismatic joint on <gearbox_reference_body> %r", self._model.name, joint.name,
                joint.parent, joint.child, joint.gearbox_reference_body)
            return
        (body1, index1, sense1), (body2, index2, sense2) = sides
        yield ((body1.number, index1, body2.number, index2, pybullet.JOINT_GEAR, (0.0, 0.0, 1.0),
                NO_PIVOT, NO_PIVOT), {"gearRatio": joint.gearbox_ratio * sense2 / sense1})

    def _seen_from(self, gearbox: JointDescription, link: str,
                   axis: Vector3) -> tuple[Body, int, float] | None:
        """Engine joint between the reference body and a link; -1 if it turns the other way."""
        reference = gearbox.gearbox_reference_body
        child = next((d.pose for d in self._model.links if d.name == gearbox.child), Pose())
        wanted = rotate((child * gearbox.pose).orientation, axis)
        for body in self.bodies:
            for held in body.tree.links[1:]:
                if held.joint is None or {held.name, held.parent} != {link, reference}:
                    continue
                described = next(d for d in self._model.links if d.name == held.described)
                own = rotate((described.pose * held.offset).orientation, held.joint.axis)
                same = sum(a * b for a, b in zip(wanted, own, strict=True)) > 0
                sign = 1.0 if same == (held.name == link) else -1.0
                return body, body.links.index[held.name], sign
        return None


def _points(joint: JointDescription) -> list[Vector3]:
    """Points of the joint's frame that coincide in both links."""
    if joint.type not in HINGES:
        return [NO_PIVOT]
    return [tuple(side * part for part in joint.axis) for side in (-LEVER, LEVER)]


def _thread(body: Body, travel: str) -> tuple[tuple, dict]:
    """A screw's travel, m, and turn, rad: travel + turn / thread_pitch = 0."""
    turn = travel.removesuffix(TRAVEL)
    ends = body.number, body.joints.index[travel], body.number, body.joints.index[turn]
    ratio = 1.0 / body.joints.description(turn).thread_pitch
    return (*ends, pybullet.JOINT_GEAR, (0.0, 0.0, 1.0), NO_PIVOT, NO_PIVOT), {"gearRatio": ratio}
