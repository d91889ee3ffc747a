"""Plays a list of joint positions by resetting the joints, while one link keeps its pose."""

from collections.abc import Sequence
from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.twist import STILL
from bullet_sim.world import World


@dataclass(frozen=True)
class JointPose:
    """Positions (rad or m) in the order of the joints' names, shown for `duration` (s)."""

    positions: tuple[float, ...]
    duration: float


class JointPoses:
    """Call `update` at every step; times as in gazebo_ros_joint_pose_trajectory.cpp, UpdateStates.

    A point is shown for its duration, as soon as the durations of those before it are over.
    """

    def __init__(self, world: World):
        self._world = world
        self._points: list[JointPose] = []
        self._model: Model | None = None

    def play(self, model: Model, names: Sequence[str], points: Sequence[JointPose],
             start: float, held: Link | None = None) -> None:
        """Play from `start` on (s, simulated; now if it is past). `held` keeps its pose.

        Joints that the model does not have are left out.
        """
        self._model, self._held = model, held
        self._names = [name if name in model.joints else None for name in names]
        self._points = list(points)
        self._next = max(start, self._world.time)
        self._shown: JointPose | None = None
        self._stand = model.pose if held is None else held.pose

    def stop(self) -> None:
        """Stop playing."""
        self._points = []

    def update(self) -> None:
        """Show the point that is due."""
        if not self._points:
            return
        if self._world.time >= self._next:
            if self._shown is not None:
                self._points.pop(0)
            if not self._points:
                return
            self._shown = self._points[0]
            self._next += self._shown.duration
        if self._shown is not None:
            self._show(self._shown)

    def _show(self, point: JointPose) -> None:
        model = self._model
        for name, position in zip(self._names, point.positions, strict=True):
            if name is not None:
                model.joints[name].reset(position)
        model.set_pose(self._place())
        model.set_twist(STILL)

    def _place(self) -> Pose:
        if self._held is None:
            return self._stand
        return self._stand * self._held.pose.inverse() * self._model.pose
