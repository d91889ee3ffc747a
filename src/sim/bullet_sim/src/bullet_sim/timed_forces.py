"""Wrenches on links and efforts on joints for a limited time (Gazebo's apply_body_wrench)."""

from collections.abc import Callable
from dataclasses import dataclass

from bullet_sim.joint import Joint
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Vector3


@dataclass(frozen=True)
class Span:
    """From `start` (s, simulated) on; a negative `duration` (s) never ends."""

    start: float
    duration: float

    def has_begun(self, time: float, slack: float) -> bool:
        """Whether it acts in a step that ends at `time`, or has acted before."""
        return time > self.start - slack

    def is_over(self, time: float, slack: float) -> bool:
        """Whether it no longer acts in that step; both ends belong to the span."""
        return self.duration >= 0 and time > self.start + self.duration + slack


@dataclass(frozen=True, eq=False)
class Wrench:
    """At a link's centre of mass, world axes."""

    link: Link
    force: Vector3  # N
    torque: Vector3  # N m
    span: Span


@dataclass(frozen=True, eq=False)
class Effort:
    """Added to the joint's drive; cut to the joint's own effort limit."""

    model: Model
    joint: Joint
    effort: float  # N m or N
    span: Span


class TimedForces:
    """All that act or will act, in the order of the requests."""

    def __init__(self):
        self.wrenches: list[Wrench] = []
        self.efforts: list[Effort] = []

    def __bool__(self) -> bool:
        return bool(self.wrenches or self.efforts)

    def apply(self, time: float, timestep: float) -> None:
        """Apply them in the step that ends at `time`; those that are over are dropped.

        Of several wrenches on one link only the last acts: gazebo_ros_api_plugin.cpp,
        wrenchBodySchedulerSlot, sets and does not add. Efforts on one joint add up.
        """
        slack = timestep / 1000  # possible error of a sum of seconds
        self.wrenches = [job for job in self.wrenches if not job.span.is_over(time, slack)]
        self.efforts = [job for job in self.efforts if not job.span.is_over(time, slack)]
        felt = {job.link: job for job in self.wrenches if job.span.has_begun(time, slack)}
        for link, job in felt.items():
            link.apply_force(job.force, job.torque)
        for job in self.efforts:
            if job.span.has_begun(time, slack):
                job.joint.add_effort(job.effort)

    def drop(self, unwanted: Callable[[Wrench | Effort], bool]) -> None:
        """Drop those that act or wait and are `unwanted`."""
        self.wrenches = [job for job in self.wrenches if not unwanted(job)]
        self.efforts = [job for job in self.efforts if not unwanted(job)]

    def drop_model(self, model: Model) -> None:
        """Drop all of a model."""
        self.drop(lambda job: model is (job.link.model if isinstance(job, Wrench) else job.model))
