"""Detects when nothing moves: then a step would only repeat the one before, and is left out.

It also detects fast motion that takes the solver long: then steps need not be solved to the last
bit. A robot on wheels that their motors hold (`held_wheels`) is solved fully.

Engines call this auto-disabling; ODE does it for each group of bodies. Ours is stricter, and for
the world as a whole: if one thing moves, or a motor is to move, everything is solved.
"""

import math
from collections import deque
from typing import Protocol

from bullet_sim.physics.assembly import Tree

REST_SPEED = 2e-4  # m/s; contacts alone make a robot at rest creep at 1.5e-5 (measured)
REST_RATE = 5e-3  # rad/s; contacts alone leave 2e-4 of a robot, 1.4e-3 of its wheels (measured)
FAST_SPEED = 0.05  # m/s; slower motion is solved exactly
FAST_RATE = 0.5  # rad/s
SAMPLE_PERIOD = 0.05  # s, simulated
SAMPLES = 10  # in a row that must find everything still
GROWTH = 1.5  # over these samples: more than that is the start of a fall
NOTHING = 1e-3  # of the limit of rest; below it, growth is only rounding errors


class SampledWheels(Protocol):
    """The driven wheels of a body (`physics.held_wheels.HeldWheels`)."""

    def sample(self) -> bool:
        """Whether their motors hold them at their speeds; called at every sample."""
        ...

    def update_inertia(self) -> None:
        """The world begins or ends to be solved fully."""
        ...


class SimulatedBody(Protocol):
    """A body for those that decide what the engine solves (`physics.body.Body`)."""

    number: int  # the engine's
    tree: Tree
    wheels: SampledWheels

    @property
    def auto_disables(self) -> bool:
        """Whether nothing but contacts and gravity acts on it."""
        ...

    def wants_to_move(self) -> bool:
        """Whether a motor is to move."""
        ...

    def speeds(self) -> tuple[float, float]:
        """Maximum speed, m/s, and angular velocity, rad/s, of all its parts."""
        ...

    def keep_feedback(self) -> None:
        """Record the loads of its joints in the last step before the rest."""
        ...

    def limit_correcting_velocity(self, part: float | None, timestep: float) -> None:
        """Let contacts correct at most this part of their depth per step (s); None: as usual."""
        ...


class AutoDisable:
    """Asked before every step. Any change from outside ends the rest."""

    def __init__(self):
        self.bodies: list[SimulatedBody] = []
        self.disabled = False  # whether the next step would change nothing
        self.is_fast = False  # whether anything but held wheels was fast in the last sample
        self.found_nan = False  # whether a speed was not finite in a sample
        self.steps = 0  # steps that were needed
        self._motions: deque[float] = deque(maxlen=SAMPLES)
        self.set_step(SAMPLE_PERIOD)

    def set_step(self, timestep: float) -> None:
        """Set the step length, s: how long everything has to be still does not depend on it."""
        self.sample_steps = max(1, round(SAMPLE_PERIOD / timestep))  # steps
        self.wake()

    def wake(self) -> None:
        """Something was changed: a motor, a pose, gravity, or the content."""
        self.disabled = False
        self._motions.clear()

    @property
    def nearly_disabled(self) -> bool:
        """Whether one more sample without motion, of `sample_steps` steps, disables everything."""
        return len(self._motions) >= SAMPLES - 1 and not self.disabled

    @property
    def is_sampling(self) -> bool:
        """Whether a sample is taken after this step."""
        return self.steps % self.sample_steps == 0

    def step_needed(self) -> bool:
        """Whether the next step would have any effect; to be called before each."""
        if self.disabled:
            return False
        self.steps += 1
        if self.is_sampling:
            self._sample()
        return True

    def _sample(self) -> None:
        motion, self.is_fast = 0.0, False
        for body in self.bodies:
            speed, rate = body.speeds()
            self.found_nan = self.found_nan or speed != speed
            fast = speed > FAST_SPEED or rate > FAST_RATE
            held = body.wheels.sample()
            self.is_fast = self.is_fast or (fast and not held)
            motion = max(motion, _motion(speed, rate, body.joints.wants_to_move()))
        if motion >= 1:
            self._motions.clear()
            return
        self._motions.append(motion)
        self.disabled = (len(self._motions) == SAMPLES
                         and motion <= max(NOTHING, GROWTH * self._motions[0]))


def _motion(speed: float, rate: float, wants_to_move: bool) -> float:
    """Motion relative to the limit of rest; infinite above it, or if not finite."""
    if speed < REST_SPEED and rate < REST_RATE and not wants_to_move:
        return max(speed / REST_SPEED, rate / REST_RATE)
    return math.inf
