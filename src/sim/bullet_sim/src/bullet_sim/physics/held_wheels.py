"""Wheels that a motor holds at a speed: solved as heavier ones, in a tenth of the iterations.

In each iteration the solver passes on as much of an impulse between ground and motor as the wheel's
inertia is of the robot's: hundreds of them for a wheel of 30 g under 2 kg that pulls a caster. But
what turns as its motor says does so whatever its inertia, and so does the robot on it. The inertia
is the file's own wherever it counts: after each command until the wheel has followed it, for motors
that the ground can overcome, and while the robot tilts, or turns so fast that the wheels' angular
momentum loads some of them more. The README has the errors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from bullet_sim.description import Sphere
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.body_joints import BodyJoints
from bullet_sim.physics.body_links import BodyLinks
from bullet_sim.physics.client import EngineBody
from bullet_sim.physics.contact_parameters import GRAVITY
from bullet_sim.physics.engine import pybullet
from bullet_sim.physics.tyres import find_tyre, rolls
from bullet_sim.pose import conjugate, rotate

HEAVIER = 0.3  # part of the robot's mass that all its held wheels weigh more, at their rims
SETTLING = 2  # steps after a command
AT_SPEED = 0.02  # rad/s from what the motor is to hold
MOST_GRIP = 1.0  # friction coefficient, and the part of the weight that a wheel carries at most:
LOADED = 0.5  # a motor that is stronger than this counts as one that the ground cannot overcome
TILTING = 0.1  # rad/s
GYROSCOPIC = 3e-3  # part of weight times radius: the most torque by which a held wheel tilts it
ALIGNED = 0.999  # cosine: the axle is a principal axis of the wheel


@dataclass(frozen=True)
class Wheel:
    """A wheel as described, and as it is solved while its motor holds it."""

    index: int  # the engine's
    own: tuple[float, ...]  # kg m^2, about its principal axes
    held: tuple[float, ...]
    torque: float  # N m, which the ground cannot overcome
    fastest: float  # (rad/s)^2, its speed times that of the robot's turn


class HeldWheels:
    """The driven wheels of one body. Told of commands by its joints, and of steps by the client."""

    def __init__(self, engine: EngineBody, joints: BodyJoints, links: BodyLinks):
        self._engine = engine
        self._joints = joints
        self._links = links
        self._wheels: dict[str, Wheel] = {}  # by joint
        self._settling: dict[str, int] = {}  # steps until it may be held
        self._held: set[str] = set()
        self._were_held = False  # since the last sample

    def set_up(self) -> None:
        """After the body was loaded: find the wheels; none of them is held."""
        self._settling.clear()
        self._held.clear()
        tree = self._engine.tree
        mass = sum(link.inertial.mass for link in tree.links)
        radii = {} if tree.fixed else {link.name: _radius(link) for link in tree.links}
        rolling = [link for link in tree.links if radii.get(link.name)]
        wheels = {link.joint.name: self._wheel(link, radii[link.name], mass, len(rolling))
                  for link in rolling}
        self._wheels = {joint: wheel for joint, wheel in wheels.items() if wheel is not None}

    def commanded(self, joint: str) -> None:
        """The motor of a joint is to do something else from the next step on."""
        if joint not in self._wheels:
            return
        self._let_go(joint)
        self._settling.pop(joint, None)
        effort = self._joints.motor(joint)[1]  # no more than dry friction: a brake, no motor
        if (effort > self._joints.description(joint).friction
                and effort >= self._wheels[joint].torque):
            self._wait(joint, SETTLING)

    def after_step(self) -> None:
        """Hold the wheels that have followed their commands."""
        for joint in list(self._settling):
            self._settling[joint] -= 1
            if self._settling[joint] > 0:
                continue
            if self._may_be_held(joint):
                self._hold(joint)
            else:
                self._wait(joint, self._engine.client.auto_disable.sample_steps)
        if not self._settling:
            self._engine.client.settling.pop(self, None)

    def sample(self) -> bool:
        """Let go of wheels that may not be held any more; whether the others were held, but for
        commands, since the last time."""
        were_held, self._were_held = self._were_held or bool(self._held), False
        for joint in [each for each in self._wheels if each in self._held]:
            if not self._may_be_held(joint):
                self._let_go(joint)
                self._wait(joint, self._engine.client.auto_disable.sample_steps)
        return were_held and all(steps <= SETTLING for steps in self._settling.values())

    def _wait(self, joint: str, steps: int) -> None:
        self._settling[joint] = steps
        self._engine.client.settling[self] = None

    def update_inertia(self) -> None:
        """The world begins or ends to be solved fully."""
        for joint in self._wheels:
            if joint in self._held:
                self._set_inertia(joint)

    def _hold(self, joint: str) -> None:
        del self._settling[joint]
        self._held.add(joint)
        self._were_held = True
        self._set_inertia(joint)

    def _let_go(self, joint: str) -> None:
        if joint in self._held:
            self._held.discard(joint)
            self._set_inertia(joint)

    def _set_inertia(self, joint: str) -> None:
        wheel = self._wheels[joint]
        # Heavier wheels end the iterations sooner: what is left open then would be more.
        heavier = joint in self._held and not self._engine.client.auto_disable.is_fast
        inertia = wheel.held if heavier else wheel.own
        self._engine.change_without_waking(
            pybullet.changeDynamics, wheel.index, localInertiaDiagonal=inertia)

    def _may_be_held(self, joint: str) -> bool:
        wanted = self._joints.motor(joint)[0]
        if self._engine.client.residual is not None:  # the world says how it is solved
            return False
        if abs(self._joints.state(joint)[1] - wanted) > AT_SPEED:
            return False
        _, (x, y, z) = self._engine.read(pybullet.getBaseVelocity)
        return math.hypot(x, y) < TILTING and abs(wanted * z) < self._wheels[joint].fastest

    def _wheel(self, link: PhysicsLink, radius: float, mass: float, count: int) -> Wheel | None:
        """One of the body's `count` wheels; None unless its axle is one of its principal axes."""
        index = self._links.index[link.name]
        turn = conjugate(self._links.com_in_link(index).orientation)
        axle = [abs(part) / math.hypot(*link.joint.axis)
                for part in rotate(turn, link.joint.axis)]
        along = axle.index(max(axle))
        if axle[along] < ALIGNED:
            return None
        own = self._engine.dynamics(index)[2]
        extra = HEAVIER / count * mass * radius ** 2
        held = tuple(part + extra * (place == along) for place, part in enumerate(own))
        weight = mass * GRAVITY * radius
        grip = min(max(each.surface.mu for each in link.collisions), MOST_GRIP)
        return Wheel(index, own, held, LOADED * grip * weight,
                     GYROSCOPIC * weight / extra if extra else 0.0)


def _radius(link: PhysicsLink) -> float:
    """Radius of what rolls about the link's joint, m; 0 if nothing does."""
    radii = [0.0]
    for collision in link.collisions:
        tyre = find_tyre(link, collision)
        if tyre is not None:
            radii.append(tyre.radius)
        elif isinstance(collision.geometry, Sphere) and rolls(link, collision):
            radii.append(collision.geometry.radius)
    return max(radii)
