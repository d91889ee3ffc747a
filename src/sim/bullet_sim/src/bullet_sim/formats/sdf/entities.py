"""What a `<world>` contains: models, actors, populations, lights and roads, where it puts them."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from xml.etree.ElementTree import Element

from bullet_sim.description import LightDescription, ModelDescription, Visual
from bullet_sim.formats.mistakes import or_without
from bullet_sim.formats.sdf.actor import read_actor
from bullet_sim.formats.sdf.frames import Frames, relative_to
from bullet_sim.formats.sdf.include import read_include
from bullet_sim.formats.sdf.light import read_light
from bullet_sim.formats.sdf.model import read_model
from bullet_sim.formats.sdf.population import MOST_MODELS, read_population
from bullet_sim.formats.sdf.road import read_road
from bullet_sim.formats.source import Source

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
    """In the order of the file, each kind with names that are unique."""

    models: dict[str, ModelDescription] = field(default_factory=dict)
    lights: dict[str, LightDescription] = field(default_factory=dict)
    roads: dict[str, Visual] = field(default_factory=dict)

    def add(self, entity: Entity, source: Source) -> None:
        """Put it in; a name that is taken is changed, with a warning."""
        kind = "model" if isinstance(entity, ModelDescription) else "light"
        there = self.models if kind == "model" else self.lights
        name = _own_name(entity.name, kind, there, source)
        there[name] = replace(entity, name=name)


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
            source.warn_once(f"<population>s of more than {MOST_MODELS} models; the rest is left"
                             " out", "populations")
            continue
        read = or_without(_read, child, source) or ()
        copies += len(read) if child.tag == "population" else 0
        for entity in read:
            if isinstance(entity, Visual):
                name = _own_name(entity.name, "road", entities.roads, source)
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
    """What one element of a world brings; nothing where it is no such thing."""
    if child.tag == "population":
        return read_population(child, source)
    entity = READERS[child.tag](child, source) if child.tag in READERS else None
    return [] if entity is None else [entity]


def _own_name(name: str, kind: str, taken: Iterable[str], source: Source) -> str:
    """A second `box` becomes `box_0`, the next one `box_1`."""
    taken = set(taken)
    if name not in taken:
        return name
    free = next(own for n in range(len(taken) + 1) if (own := f"{name}_{n}") not in taken)
    source.warn_once(f"a {kind} named {name!r} is there already; this one becomes {free!r}")
    return free
