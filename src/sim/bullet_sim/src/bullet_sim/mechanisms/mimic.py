"""A joint that follows another one: `multiplier` times its position, plus `offset`."""

from dataclasses import dataclass

from bullet_sim.control.pid import Pid
from bullet_sim.joint import Joint
from bullet_sim.physics.auto_disable import REST_RATE, REST_SPEED

FOLLOWING_EFFORT = 1e3  # N m or N: more than any finger's; the joint must be at its position
CATCH_UP = 5  # steps in which a gap is closed
SETTLED = 1e-4  # rad or m: closer to a leader at rest, it is held, so that the world may rest


@dataclass(frozen=True)
class MimicParameters:
    """Defaults are those of roboticsgroup's plugin."""

    multiplier: float = 1.0
    offset: float = 0.0  # rad or m
    sensitiveness: float = 0.0  # rad or m: smaller gaps are ignored
    max_effort: float = 1.0  # N m or N, with a PID


class MimicJoint:
    """Without a PID the follower is moved to its position; with one, an effort drives it there."""

    def __init__(self, leader: Joint, follower: Joint, parameters: MimicParameters,
                 pid: Pid | None = None):
        self._leader, self._follower = leader, follower
        self._parameters = parameters
        self._pid = pid

    def update(self, timestep: float) -> None:
        """Call at every step (s)."""
        p = self._parameters
        gap = self._target() - self._follower.position
        if self._pid is not None:
            if abs(gap) >= p.sensitiveness:
                effort = self._pid.compute(gap, timestep)
                self._follower.drive_effort(max(-p.max_effort, min(p.max_effort, effort)))
            return
        rate = 0.0
        if abs(gap) >= max(p.sensitiveness, SETTLED if self._leader_rests() else 0.0):
            rate = gap / (CATCH_UP * timestep) + p.multiplier * self._leader.velocity
        self._follower.drive_velocity(rate, FOLLOWING_EFFORT)

    def _leader_rests(self) -> bool:
        slides = self._leader.description.type == "prismatic"
        return abs(self._leader.velocity) < (REST_SPEED if slides else REST_RATE)

    def _target(self) -> float:
        p, limits = self._parameters, self._follower.description
        wanted = p.multiplier * self._leader.position + p.offset
        return max(limits.lower, min(limits.upper, wanted))

    def reset(self) -> None:
        """Forget past errors."""
        if self._pid is not None:
            self._pid.reset()
