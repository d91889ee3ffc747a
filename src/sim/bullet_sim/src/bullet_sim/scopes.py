"""Scoped names of parts, with the names of their models in front: `model::link`.

A model's own name may contain `::`, so a name alone does not tell where the model's ends.
"""

from collections.abc import Iterator, Mapping

from bullet_sim.description import LightDescription
from bullet_sim.errors import UnknownName
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.nested import SCOPE, find_nested_model
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.twist import Twist

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
