"""The state of a model: its bodies, and its links' poses and twists, read once per step.

What links and joints need from their model; `Model` adds the links and joints themselves.
"""

from bullet_sim.description import ModelDescription
from bullet_sim.physics.assembly import WORLD
from bullet_sim.physics.body import Body
from bullet_sim.pose import Pose
from bullet_sim.twist import STILL, Twist, shifted_twist


class ModelState:
    """Everything is in world coordinates."""

    def __init__(self, name: str, description: ModelDescription, pose: Pose):
        self.name = name
        self.description = description
        self.static = description.static
        self.initial_pose = pose
        self.bodies: list[Body] = []
        self._fixed_pose = pose  # of a model that is static or has no links
        self._link_states: dict[str, tuple[Pose, Twist]] | None = None

    def forget(self) -> None:
        """Drop the cached link states."""
        self._link_states = None

    def link_states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of each link, by name."""
        if self._link_states is None:
            self._link_states = {}
            for body in self.bodies:
                self._link_states.update(body.link_states())
            self._link_states.pop(WORLD, None)
        return self._link_states

    @property
    def pose(self) -> Pose:
        """Model frame, which keeps its pose relative to the first link."""
        if self.static or not self.description.links:
            return self._fixed_pose
        first = self.description.links[0]
        return self.link_states()[first.name][0] * first.pose.inverse()

    @property
    def twist(self) -> Twist:
        """Velocity of the model frame's origin, world axes."""
        if self.static or not self.description.links:
            return STILL
        pose, twist = self.link_states()[self.description.links[0].name]
        return shifted_twist(twist, pose.position, self.pose.position)

    def set_pose(self, pose: Pose) -> None:
        """Move the model as a whole; joints keep their positions."""
        self._displace(self.bodies, pose * self.pose.inverse())
        self._fixed_pose = pose

    def move_body(self, body: Body, change: Pose) -> None:
        """Move one of its bodies, or all of a static model's, by a displacement in the world."""
        self._displace(self.bodies if self.static else [body], change)
        self._fixed_pose = change * self._fixed_pose

    def _displace(self, bodies: list[Body], change: Pose) -> None:
        for body in bodies:
            body.set_base_frame(change * body.base_frame())
        self.forget()

    def set_velocity(self, twist: Twist) -> None:
        """Move as a whole with that twist of the model frame; joints keep turning."""
        for body in self.bodies:
            if not body.tree.fixed_base:
                body.set_twist(twist, self.pose.position)
        self.forget()
