"""Reads SDF worlds: models, lights, physics, scene and the poses of a saved `<state>`."""

import itertools
from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass, field, replace
from xml.etree.ElementTree import Element

from bullet_sim.description import (
    LightDescription,
    ModelDescription,
    PhysicsDescription,
    SphericalDescription,
    Visual,
    WorldDescription,
)
from bullet_sim.formats.mistakes import all_that_can, or_without
from bullet_sim.formats.sdf.actor import read_actor
from bullet_sim.formats.sdf.frames import Frames, relative_to
from bullet_sim.formats.sdf.include import read_include
from bullet_sim.formats.sdf.model import read_model
from bullet_sim.formats.sdf.population import MOST_MODELS, read_population
from bullet_sim.formats.sdf.scene import read_light, read_road, read_scene
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.sdf.state import apply_state
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import fields, integer, number, vector


def read_world(element: Element, source: Source) -> WorldDescription:
    """A `<world>`, with its models in the order of the file."""
    where = f"world {element.get('name', 'default')!r}"
    usual = WorldDescription()
    physics = _physics_element(element)
    # In <physics> up to SDF 1.5.
    old_gravity = vector(physics, "gravity", usual.gravity, where)
    old_field = vector(physics, "magnetic_field", usual.magnetic_field, where)
    entities = read_entities(element, source)
    world = WorldDescription(
        name=element.get("name", usual.name),
        gravity=vector(element, "gravity", old_gravity, where),
        magnetic_field=vector(element, "magnetic_field", old_field, where),
        physics=_read_physics(physics, where),
        scene=read_scene(element.find("scene"), where),
        spherical=_spherical(element.find("spherical_coordinates"), where),
        models=tuple(entities.models.values()),
        lights=tuple(entities.lights.values()),
        plugins=read_plugins(element),
        scenery=tuple(entities.roads.items()),
    )
    for state in element.findall("state"):
        world = apply_state(_with_insertions(world, state, source), state)
    return world


def _with_insertions(
    world: WorldDescription, state: Element, source: Source
) -> WorldDescription:
    """Add entities that were inserted after the world was opened; those in the file are kept."""
    models = {model.name: model for model in world.models}
    for model in all_that_can(read_model, state.findall("insertions/model"), source):
        models.setdefault(model.name, model)
    lights = {light.name: light for light in world.lights}
    for light in all_that_can(read_light, state.findall("insertions/light")):
        lights.setdefault(light.name, light)
    return replace(world, models=tuple(models.values()), lights=tuple(lights.values()))


def _physics_element(element: Element) -> Element:
    """The profile marked as default, else the first one."""
    profiles = element.findall("physics")
    marked = [profile for profile in profiles if profile.get("default") in ("true", "1")]
    return (marked or profiles or [Element("physics")])[0]


def _read_physics(element: Element, world: str) -> PhysicsDescription:
    where = f"{world} <physics>"
    usual = PhysicsDescription()
    solver = "ode/solver/"
    old_step = number(element, solver + "dt", usual.max_step_size, where)  # names of SDF 1.2
    old_rate_hz = number(element, "update_rate", usual.real_time_update_rate, where)
    return PhysicsDescription(
        max_step_size=number(element, "max_step_size", old_step, where),
        real_time_update_rate=number(element, "real_time_update_rate", old_rate_hz, where),
        real_time_factor=number(element, "real_time_factor", usual.real_time_factor, where),
        max_contacts=integer(element, "max_contacts", usual.max_contacts, where),
        iterations=integer(element, solver + "iters", usual.iterations, where),
        precon_iterations=integer(
            element, solver + "precon_iters", usual.precon_iterations, where
        ),
        sor=number(element, solver + "sor", usual.sor, where),
        residual=number(element, "bullet/solver/residual", 0.0, where) or None,
        **fields(number, element, "cfm erp contact_max_correcting_vel contact_surface_layer", usual,
                 where, "ode/constraints/"),
    )


def _spherical(element: Element | None, world: str) -> SphericalDescription | None:
    """Location of the world on Earth; None if the file does not give it.

    The surface model is always WGS84 and the world frame east-north-up, whatever is written.
    """
    if element is None:
        return None
    return SphericalDescription(**fields(
        number, element, "latitude_deg longitude_deg elevation heading_deg",
        SphericalDescription(), f"{world} <spherical_coordinates>"))


Entity = ModelDescription | LightDescription
READERS: dict[str, Callable[[Element, Source], Entity | Visual | None]] = {
    "model": read_model,
    "actor": read_actor,
    "light": lambda element, _: read_light(element),
    "road": read_road,
    "include": read_include,
}


@dataclass
class Entities:
    """Entities in the order of the file, with unique names within each kind."""

    models: dict[str, ModelDescription] = field(default_factory=dict)
    lights: dict[str, LightDescription] = field(default_factory=dict)
    roads: dict[str, Visual] = field(default_factory=dict)
    _numbers: dict[tuple[str, str], Iterator[int]] = field(default_factory=dict)

    def add(self, entity: Entity, source: Source) -> None:
        """Add an entity; a name that is taken is changed, with a warning."""
        kind = "model" if isinstance(entity, ModelDescription) else "light"
        there = self.models if kind == "model" else self.lights
        name = self.own_name(entity.name, kind, there, source)
        there[name] = replace(entity, name=name)

    def own_name(self, name: str, kind: str, taken: Container[str], source: Source) -> str:
        """A second `box` becomes `box_0`, the next one `box_1`."""
        if name not in taken:
            return name
        numbers = self._numbers.setdefault((kind, name), itertools.count())
        free = next(own for number in numbers if (own := f"{name}_{number}") not in taken)
        source.warn_once(f"a {kind} named {name!r} is there already; this one becomes {free!r}")
        return free


def read_entities(element: Element, source: Source) -> Entities:
    """All entities of a world, in the world's frame."""
    frames = Frames(source, f"world {element.get('name', 'default')}")
    for frame in element.findall("frame"):
        frames.add_element(frame, frame.get("attached_to", ""), f"frame {frame.get('name')!r}")
    found = []
    entities = Entities()
    copies = 0
    for child in element:
        if child.tag == "population" and copies >= MOST_MODELS:
            source.warn_once(f"<population>s of over {MOST_MODELS} models; the rest is left out")
            continue
        read = or_without(_read, child, source) or ()
        copies += len(read) if child.tag == "population" else 0
        for entity in read:
            if isinstance(entity, Visual):
                name = entities.own_name(entity.name, "road", entities.roads, source)
                entities.roads[name] = entity
            else:
                found.append((entity, relative_to(child)))
    for entity, given_in in found:
        frames.add(entity.name, given_in, entity.pose)
    for entity, given_in in found:
        if given_in:
            placed = frames.in_model(given_in) * entity.pose
            entity = replace(entity, pose=placed)
        entities.add(entity, source)
    return entities


def _read(child: Element, source: Source) -> list[Entity | Visual]:
    """The content of one element of a world; empty if it is none of these kinds."""
    if child.tag == "population":
        return read_population(child, source)
    entity = READERS[child.tag](child, source) if child.tag in READERS else None
    return [] if entity is None else [entity]
