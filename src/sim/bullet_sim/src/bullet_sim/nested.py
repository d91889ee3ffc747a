"""A model inside another: the part of it whose links are named `nested::link`."""

from collections.abc import Iterable

from bullet_sim.description import JointDescription
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.twist import STILL, Twist, shifted_twist

SCOPE = "::"


class NestedModel:
    """A model without the models nested in it; with an empty `name`, the outermost one."""

    def __init__(self, model: Model, name: str = ""):
        self.model = model
        self.name = name  # nested model, scoped by those around it except the outermost
        self._scope = f"{name}{SCOPE}" if name else ""
        self.child_names = [
            child.removeprefix(self._scope) for child in model.description.child_models
            if child.startswith(self._scope)
            and SCOPE not in child.removeprefix(self._scope) and child != name]

    @property
    def parent_name(self) -> str:
        """The model around it, unscoped; empty for the outermost."""
        if not self.name:
            return ""
        around = self.name.rpartition(SCOPE)[0]
        return around.rpartition(SCOPE)[2] or self.model.name

    def links(self) -> list[Link]:
        """Its own links, in the order of the description."""
        return [link for name, link in self.model.links.items() if self.is_own(name)]

    def joints(self) -> list[JointDescription]:
        """Its own joints."""
        return [joint for joint in self.model.description.joints if self.is_own(joint.name)]

    def unscoped(self, name: str) -> str:
        """A link's or joint's name inside this model."""
        return name.removeprefix(self._scope)

    def is_own(self, name: str) -> bool:
        """Whether a link or joint of that name is in this model, and in none nested in it."""
        inner = [f"{self._scope}{child}{SCOPE}" for child in self.child_names]
        return name.startswith(self._scope) and not name.startswith(tuple(inner))

    @property
    def pose(self) -> Pose:
        """Its frame in the world, which keeps its pose relative to its first link."""
        if not self.name:
            return self.model.pose
        frame, first = self.model.description.child_poses[self.name], self._first()
        if first is None:
            return self.model.pose * frame
        return first.pose * first.description.pose.inverse() * frame

    @property
    def twist(self) -> Twist:
        """Velocity of its frame's origin, world axes."""
        if not self.name:
            return self.model.twist
        first = self._first()
        if first is None or self.model.static:
            return STILL
        return shifted_twist(first.twist, first.pose.position, self.pose.position)

    def _first(self) -> Link | None:
        return next((link for name, link in self.model.links.items()
                     if name.startswith(self._scope)), None)


def find_nested_model(models: Iterable[Model], name: str) -> NestedModel | None:
    """A model by its name, or a nested one as `outer::nested` or, unscoped, the first found."""
    nested = None
    for model in models:
        if name == model.name:
            return NestedModel(model)
        for child in model.description.child_models:
            scoped = name == f"{model.name}{SCOPE}{child}"
            if nested is None and (scoped or name == child.rpartition(SCOPE)[2]):
                nested = NestedModel(model, child)
    return nested
