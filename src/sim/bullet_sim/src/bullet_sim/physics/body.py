"""One engine body: poses, velocities and motors of its links, by link name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from bullet_sim.description import JointDescription, LinkDescription
from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.joint_group import JointGroup
from bullet_sim.physics.quiet import pybullet
from bullet_sim.pose import IDENTITY, Pose, Vector3, normalised

FASTEST_JOINT = 1e3  # rad/s or m/s; the engine's own bound of 100 would hold a small wheel back
BASE = -1  # PyBullet's number of a body's base link


@dataclass(frozen=True)
class Twist:
    """Velocity of a frame's origin and its rate of turn, both in world axes."""

    linear: Vector3 = (0.0, 0.0, 0.0)  # m/s
    angular: Vector3 = (0.0, 0.0, 0.0)  # rad/s


STILL = Twist()


class Body:
    """A loaded tree. Link frames are those of the description, in the world."""

    def __init__(self, client: PhysicsClient, tree: Tree, pose_world_model: Pose):
        self.tree = tree
        self._client = client
        self.base_pose_model = tree.links[0].pose_parent
        self.number = client.load(tree, pose_world_model * self.base_pose_model)
        self._index = {link.name: number - 1 for number, link in enumerate(tree.links)}
        self._physics_link = {link.name: link for link in tree.links}
        self._joint_index = {
            link.joint.name: self._index[link.name] for link in tree.links if link.joint
        }
        self._link_indices = list(range(len(tree.links) - 1))
        inertial = self._dynamics(BASE)
        self._pose_base_com = Pose(inertial[3], inertial[4])
        self._set_up_contacts()
        self._motors: dict[str, tuple[float, float]] = {}  # joint: rate and effort it is held with
        for name in self._joint_index:
            self.release(name)
        client.rest.bodies.append(self)
        client.planes.put(self.number, tree, self.base_frame())

    # --- set-up

    def _call(self, function, *args, **kwargs):
        return self._client.call(function, self.number, *args, **kwargs)

    def _read(self, function, *args, **kwargs):
        return self._client.read(function, self.number, *args, **kwargs)

    def _dynamics(self, index: int):
        return self._read(pybullet.getDynamicsInfo, index)

    def _set_up_contacts(self) -> None:
        # PyBullet damps by default; Gazebo does so only where <velocity_decay> asks for it.
        self._call(pybullet.changeDynamics, BASE, maxJointVelocity=FASTEST_JOINT)
        for link in self.tree.links:
            values = {"linearDamping": link.linear_damping,
                      "angularDamping": link.angular_damping, "jointDamping": 0.0}
            if link.joint is not None:
                values["jointDamping"] = link.joint.damping
            if link.collisions:
                surface = link.collisions[0].surface
                # The engine multiplies two frictions where ODE takes the smaller one: what never
                # moves counts as 1, so that the product is the moving part's own coefficient.
                values["lateralFriction"] = min(surface.mu, 1.0) if self.tree.fixed else surface.mu
                values["restitution"] = surface.restitution
                values["rollingFriction"] = values["spinningFriction"] = 0.0
            self._call(pybullet.changeDynamics, self._index[link.name], **values)

    # --- links

    def link_states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of every described link frame."""
        states = {}
        base = self.tree.links[0]
        linear, angular = self._read(pybullet.getBaseVelocity)
        states[base.described] = _described(
            base, self.base_frame(), self._com_position(BASE), linear, angular
        )
        rows = self._read(pybullet.getLinkStates, self._link_indices, computeLinkVelocity=1,
                          computeForwardKinematics=1) if self._link_indices else ()
        for link, row in zip(self.tree.links[1:], rows, strict=True):
            if link.name == link.described:
                states[link.name] = _described(link, Pose(row[4], row[5]), row[0], row[6], row[7])
        return states

    def base_frame(self) -> Pose:
        """The base link's frame in the world, as the engine has it."""
        pose_com = Pose(*self._read(pybullet.getBasePositionAndOrientation))
        return pose_com * self._pose_base_com.inverse()

    def set_base_frame(self, frame: Pose) -> None:
        """Put the base link's frame somewhere at once; joints keep their positions."""
        frame = Pose(frame.position, normalised(frame.orientation))
        com = frame * self._pose_base_com
        self._call(pybullet.resetBasePositionAndOrientation, com.position, com.orientation)
        self._client.planes.put(self.number, self.tree, frame)

    def set_twist(self, twist: Twist, origin: Vector3) -> None:
        """Move as a rigid whole whose point `origin` (world) has that twist."""
        com = self._com_position(BASE)
        arm = [c - o for c, o in zip(com, origin, strict=True)]
        spin = cross(twist.angular, arm)
        linear = [v + s for v, s in zip(twist.linear, spin, strict=True)]
        self._call(pybullet.resetBaseVelocity, linear, twist.angular)

    def apply_force(self, link: str, force: Vector3, torque: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Force (N) at the centre of mass and torque (N m), world axes, during the next step."""
        index = self._index[link]
        where = self._com_position(index)
        self._call(pybullet.applyExternalForce, index, force, where, pybullet.WORLD_FRAME)
        if any(torque):
            self._call(pybullet.applyExternalTorque, index, torque, pybullet.WORLD_FRAME)

    def _com_position(self, index: int) -> Vector3:
        if index == BASE:
            return self._read(pybullet.getBasePositionAndOrientation)[0]
        return self._read(pybullet.getLinkState, index)[0]

    # --- joints

    def joint_state(self, joint: str) -> tuple[float, float]:
        """Position and rate: rad and rad/s, or m and m/s."""
        row = self._read(pybullet.getJointState, self._joint_index[joint])
        return row[0], row[1]

    def reset_joint(self, joint: str, position: float, velocity: float = 0.0) -> None:
        """Put a joint somewhere at once."""
        self._call(pybullet.resetJointState, self._joint_index[joint], position, velocity)

    def drive_velocity(self, joint: str, velocity: float, effort: float) -> None:
        """Motor that holds a rate with at most `effort` (N m or N), until told otherwise."""
        if self._motors.get(joint) == (velocity, effort):
            return
        self._motors[joint] = (velocity, effort)
        self._call(pybullet.setJointMotorControl2, self._joint_index[joint],
                   pybullet.VELOCITY_CONTROL, targetVelocity=velocity, force=effort)

    def drive_effort(self, joint: str, effort: float) -> None:
        """Effort (N m or N) during the next step."""
        self._motors.pop(joint, None)
        self._call(pybullet.setJointMotorControl2, self._joint_index[joint],
                   pybullet.TORQUE_CONTROL, force=effort)

    def release(self, joint: str) -> None:
        """No motor; the joint's own dry friction stays (PyBullet's default is a brake)."""
        friction = self.joint_description(joint).friction
        self.drive_velocity(joint, 0.0, friction)

    def joint_description(self, joint: str) -> JointDescription:
        """The joint as described."""
        return self.tree.links[self._joint_index[joint] + 1].joint

    def joint_names(self) -> list[str]:
        """Joints that can move."""
        return list(self._joint_index)

    def joint_group(self, joints: Iterable[str]) -> JointGroup:
        """Those of the joints that are this body's."""
        mine = {joint: self._joint_index[joint] for joint in joints if joint in self._joint_index}
        return JointGroup(self._client, self.number, mine)

    def remove(self) -> None:
        """Take the body out of the world."""
        self._client.rest.bodies.remove(self)
        self._client.planes.remove(self.number)
        self._call(pybullet.removeBody)

    # --- rest

    def wants_to_move(self) -> bool:
        """Whether a motor is to hold a rate other than zero."""
        return any(velocity and effort for velocity, effort in self._motors.values())

    def speeds(self) -> tuple[float, float]:
        """Greatest speed, m/s, and rate of turn, rad/s, of base and joints."""
        linear, angular = self._read(pybullet.getBaseVelocity)
        speed, rate = max(map(abs, linear)), max(map(abs, angular))
        for joint, index in self._joint_index.items():
            moved = abs(self._read(pybullet.getJointState, index)[1])
            if self.joint_description(joint).type == "prismatic":
                speed = max(speed, moved)
            else:
                rate = max(rate, moved)
        return speed, rate


def cross(a, b) -> Vector3:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _described(link: PhysicsLink, physics_frame: Pose, com: Vector3, linear: Vector3,
               angular: Vector3) -> tuple[Pose, Twist]:
    """From the engine's frame and velocity of the centre of mass to those of the described link."""
    frame = physics_frame if link.offset is IDENTITY else physics_frame * link.offset.inverse()
    arm = [f - c for f, c in zip(frame.position, com, strict=True)]
    spin = cross(angular, arm)
    velocity = (linear[0] + spin[0], linear[1] + spin[1], linear[2] + spin[2])
    return frame, Twist(velocity, tuple(angular))


def gravity_compensation(link: LinkDescription, gravity: Vector3) -> Vector3:
    """Force that makes a link with `<gravity>` off weightless, N."""
    return tuple(-link.inertial.mass * g for g in gravity)
