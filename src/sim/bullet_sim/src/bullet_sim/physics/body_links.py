"""The links of an engine body: their poses, their motion, and forces on them."""

from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.client import BASE, EngineBody
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import IDENTITY, Pose, Vector3, normalised
from bullet_sim.twist import Twist, cross

FAR_AWAY = (0.0, 0.0, 1e5)  # m


class BodyLinks:
    """The links of a Body. Link frames are those of the description, in the world."""

    def __init__(self, engine: EngineBody):
        self._engine = engine
        links = engine.tree.links
        self.index = {link.name: number - 1 for number, link in enumerate(links)}  # the engine's
        self._others = list(range(len(links) - 1))  # all but the base
        self._pose_base_com = self._com_pose_base = IDENTITY

    def set_up(self) -> None:
        """After the body was loaded: read where the base's centre of mass and its axes are."""
        self._pose_base_com = self.com_in_link(BASE)
        self._com_pose_base = self._pose_base_com.inverse()

    def com_in_link(self, index: int) -> Pose:
        """Centre of mass and principal axes in the engine's link frame."""
        row = self._engine.dynamics(index)
        return Pose(row[3], row[4])

    def states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of every described link frame."""
        states = {}
        base = self._engine.tree.links[0]
        linear, angular = self._engine.read(pybullet.getBaseVelocity)
        com = Pose(*self._engine.read(pybullet.getBasePositionAndOrientation))
        states[base.described] = _described(
            base, com * self._com_pose_base, com.position, linear, angular
        )
        rows = self._engine.read(
            pybullet.getLinkStates, self._others, computeLinkVelocity=1,
            computeForwardKinematics=1) if self._others else ()
        for link, row in zip(self._engine.tree.links[1:], rows, strict=True):
            if link.name == link.described:
                states[link.name] = _described(link, Pose(row[4], row[5]), row[0], row[6], row[7])
        return states

    def base_frame(self) -> Pose:
        """The base link's frame in the world, from the engine."""
        pose_com = Pose(*self._engine.read(pybullet.getBasePositionAndOrientation))
        return pose_com * self._com_pose_base

    def engine_frame(self, index: int) -> Pose:
        """Frame in the world of the engine's link with that number."""
        if index == BASE:
            return self.base_frame()
        row = self._engine.read(pybullet.getLinkState, index, computeForwardKinematics=1)
        return Pose(row[4], row[5])

    def frame(self, link: str) -> Pose:
        """Frame in the world of the engine's link of that name."""
        return self.engine_frame(self.index[link])

    def set_base_frame(self, frame: Pose) -> None:
        """Set the pose of the base link's frame at once; joints keep their positions."""
        if not self._engine.is_number("pose", *frame.position, *frame.orientation):
            return
        frame = Pose(frame.position, normalised(frame.orientation))
        com = frame * self._pose_base_com
        if not self._engine.tree.fixed:
            # Via a distant position: otherwise contacts of the old position, with their
            # depths, would count at the new one.
            self._engine.change_without_waking(
                pybullet.resetBasePositionAndOrientation, FAR_AWAY, com.orientation)
            self._engine.client.change_without_waking(pybullet.performCollisionDetection)
        self._engine.change(pybullet.resetBasePositionAndOrientation, com.position, com.orientation)
        self._engine.client.planes.put(self._engine.number, self._engine.tree, frame)

    def set_twist(self, twist: Twist, origin: Vector3) -> None:
        """Move as a rigid whole whose point `origin` (world) has that twist."""
        if not self._engine.is_number("velocity", *twist.linear, *twist.angular):
            return
        com = self._com_position(BASE)
        arm = [c - o for c, o in zip(com, origin, strict=True)]
        spin = cross(twist.angular, arm)
        linear = [v + s for v, s in zip(twist.linear, spin, strict=True)]
        self._engine.change(pybullet.resetBaseVelocity, linear, twist.angular)

    def apply_steady_force(self, link: str, force: Vector3) -> None:
        """As `apply_force`, for forces of every step: it does not end the world's rest."""
        index = self.index[link]
        self._engine.change_without_waking(pybullet.applyExternalForce, index, force,
                                           self._com_position(index), pybullet.WORLD_FRAME)

    def apply_force(self, link: str, force: Vector3, torque: Vector3) -> None:
        """Force (N) at the centre of mass and torque (N m), world axes, during the next step."""
        if not self._engine.is_number("force", *force, *torque):
            return
        index = self.index[link]
        where = self._com_position(index)
        self._engine.change(pybullet.applyExternalForce, index, force, where, pybullet.WORLD_FRAME)
        if any(torque):
            self._engine.change(pybullet.applyExternalTorque, index, torque, pybullet.WORLD_FRAME)

    def add_twist(self, twist: Twist, origin: Vector3) -> None:
        """Add the motion of a rigid whole to the base's, where `origin` (world) is its centre."""
        linear, angular = self._engine.read(pybullet.getBaseVelocity)
        arm = [c - o for c, o in zip(self._com_position(BASE), origin, strict=True)]
        spin = cross(twist.angular, arm)
        self._engine.change(pybullet.resetBaseVelocity,
                            [v + a + s for v, a, s in zip(linear, twist.linear, spin, strict=True)],
                            [w + a for w, a in zip(angular, twist.angular, strict=True)])

    def com_motion(self, index: int) -> tuple[Pose, Vector3, Vector3]:
        """Centre of mass and principal axes in the world, their velocity and angular velocity."""
        if index == BASE:
            pose = Pose(*self._engine.read(pybullet.getBasePositionAndOrientation))
            return pose, *self._engine.read(pybullet.getBaseVelocity)
        row = self._engine.read(pybullet.getLinkState, index, computeLinkVelocity=1)
        return Pose(row[0], row[1]), row[6], row[7]

    def _com_position(self, index: int) -> Vector3:
        if index == BASE:
            return self._engine.read(pybullet.getBasePositionAndOrientation)[0]
        return self._engine.read(pybullet.getLinkState, index)[0]


def _described(link: PhysicsLink, physics_frame: Pose, com: Vector3, linear: Vector3,
               angular: Vector3) -> tuple[Pose, Twist]:
    """From the engine's frame and velocity of the centre of mass to those of the described link."""
    frame = physics_frame if link.offset is IDENTITY else physics_frame * link.offset.inverse()
    arm = [f - c for f, c in zip(frame.position, com, strict=True)]
    spin = cross(angular, arm)
    velocity = (linear[0] + spin[0], linear[1] + spin[1], linear[2] + spin[2])
    return frame, Twist(velocity, tuple(angular))
