"""Scoped names, `model::link`, and models inside others, whose links are named `nested::link`.

A model's own name may contain `::`, so a name alone does not tell where the model's ends.
"""

from collections.abc import Iterable, Iterator, Mapping

from bullet_sim.description import JointDescription, LightDescription
from bullet_sim.errors import UnknownName
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.twist import STILL, Twist, shifted_twist

SCOPE = "::"
INERTIAL_FRAMES = ("", "world", "map", "/map")  # other names of the world's frame


def find_link(models: Mapping[str, Model], name: str) -> Link:
    """A link by scoped name, or by an unscoped name that only one model has; else UnknownName."""
    unknown = None
    for model, rest in owners(models, name):
        try:
            return model.link(rest)
        except UnknownName as error:
            unknown = error
    if unknown is not None:
        raise unknown
    found = [model.links[name] for model in models.values() if name in model.links]
    if len(found) == 1:
        return found[0]
    known = [link.scoped_name for model in models.values() for link in model.links.values()]
    raise UnknownName("link", name, known)


def find_frame(models: Mapping[str, Model], name: str) -> tuple[Pose, Twist]:
    """Pose and twist of a model, a link, or the world by its usual names; else UnknownName."""
    if part := find_nested_model(models.values(), name):
        return part.pose, part.twist
    try:
        link = find_link(models, name)
    except UnknownName:
        if name in INERTIAL_FRAMES:
            return IDENTITY, Twist()
        raise
    return link.pose, link.twist


def owners(models: Mapping[str, Model], name: str) -> Iterator[tuple[Model, str]]:
    """Models with which a scoped name may begin, the longest first, and the rest of it."""
    words = name.split(SCOPE)
    for count in range(len(words) - 1, 0, -1):
        model = models.get(SCOPE.join(words[:count]))
        if model is not None:
            yield model, SCOPE.join(words[count:])


def light_name(link: Link, light: LightDescription) -> str:
    """Name in the world of a light on a link."""
    return f"{link.scoped_name}{SCOPE}{light.name}"


def carried_lights(model: Model) -> list[str]:
    """Names in the world of all lights on a model."""
    return [light_name(link, light) for link in model.links.values()
            for light in link.description.lights]


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
