"""Reads SDF worlds: models, lights, physics, scene and the poses of a saved `<state>`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from xml.etree.ElementTree import Element

from bullet_sim.description import (
    LightDescription,
    ModelDescription,
    PhysicsDescription,
    SceneDescription,
    WorldDescription,
)
from bullet_sim.formats.sdf_light import read_light
from bullet_sim.formats.sdf_sensor import read_plugins
from bullet_sim.formats.sdf_state import apply_state
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import colour, flag, integer, number, vector

IncludeReader = Callable[[Element, Source], ModelDescription | LightDescription | None]
ModelReader = Callable[[Element, Source], ModelDescription]
NOT_SUPPORTED = ("actor", "population", "road", "heightmap")


def read_world(
    element: Element, source: Source, read_model: ModelReader, read_include: IncludeReader
) -> WorldDescription:
    """A `<world>`, its models in the order of the file."""
    where = f"world {element.get('name', 'default')!r}"
    for tag in NOT_SUPPORTED:
        if element.find(tag) is not None:
            source.warn_once(f"{where}: <{tag}> is not supported, left out")
    usual = WorldDescription()
    physics = _physics_element(element)
    old_gravity = vector(physics, "gravity", usual.gravity, where)  # its place up to SDF 1.5
    models, lights = _entities(element, source, read_model, read_include)
    world = WorldDescription(
        name=element.get("name", usual.name),
        gravity=vector(element, "gravity", old_gravity, where),
        magnetic_field=vector(element, "magnetic_field", usual.magnetic_field, where),
        physics=_read_physics(physics, where),
        scene=_read_scene(element.find("scene"), where),
        models=tuple(models),
        lights=tuple(lights),
        plugins=read_plugins(element),
    )
    for state in element.findall("state"):
        inserted = [read_model(model, source) for model in state.findall("insertions/model")]
        world = apply_state(replace(world, models=(*world.models, *inserted)), state)
    return world


def _entities(
    element: Element, source: Source, read_model: ModelReader, read_include: IncludeReader
) -> tuple[list[ModelDescription], list[LightDescription]]:
    """Models and lights, written out or included, with names that are unique."""
    models: list[ModelDescription] = []
    lights: list[LightDescription] = []
    for child in element:
        entity = None
        if child.tag == "model":
            entity = read_model(child, source)
        elif child.tag == "light":
            entity = read_light(child)
        elif child.tag == "include":
            entity = read_include(child, source)
        if isinstance(entity, ModelDescription):
            models.append(_with_own_name(entity, models, source))
        elif entity is not None:
            lights.append(entity)
    return models, lights


def _with_own_name(
    model: ModelDescription, others: list[ModelDescription], source: Source
) -> ModelDescription:
    """A second `box` becomes `box_0`, the next one `box_1`."""
    taken = {other.name for other in others}
    if model.name not in taken:
        return model
    name = next(name for n in range(len(taken) + 1) if (name := f"{model.name}_{n}") not in taken)
    source.warn_once(f"a model named {model.name!r} is there already; this one becomes {name!r}")
    return replace(model, name=name)


def _physics_element(element: Element) -> Element:
    """The profile marked as default, else the first."""
    profiles = element.findall("physics")
    marked = [profile for profile in profiles if profile.get("default") in ("true", "1")]
    return (marked or profiles or [Element("physics")])[0]


def _read_physics(element: Element, world: str) -> PhysicsDescription:
    where = f"{world} <physics>"
    usual = PhysicsDescription()
    solver, limits = "ode/solver/", "ode/constraints/"
    return PhysicsDescription(
        max_step_size=number(element, "max_step_size", usual.max_step_size, where),
        real_time_update_rate=number(
            element, "real_time_update_rate", usual.real_time_update_rate, where
        ),
        real_time_factor=number(element, "real_time_factor", usual.real_time_factor, where),
        max_contacts=integer(element, "max_contacts", usual.max_contacts, where),
        iterations=integer(element, solver + "iters", usual.iterations, where),
        precon_iterations=integer(
            element, solver + "precon_iters", usual.precon_iterations, where
        ),
        sor=number(element, solver + "sor", usual.sor, where),
        cfm=number(element, limits + "cfm", usual.cfm, where),
        erp=number(element, limits + "erp", usual.erp, where),
        contact_max_correcting_vel=number(
            element, limits + "contact_max_correcting_vel", usual.contact_max_correcting_vel, where
        ),
        contact_surface_layer=number(
            element, limits + "contact_surface_layer", usual.contact_surface_layer, where
        ),
    )


def _read_scene(element: Element | None, world: str) -> SceneDescription:
    usual = SceneDescription()
    if element is None:
        return usual
    where = f"{world} <scene>"
    return SceneDescription(
        ambient=colour(element, "ambient", usual.ambient, where),
        background=colour(element, "background", usual.background, where),
        shadows=flag(element, "shadows", usual.shadows),
        sky=element.find("sky") is not None,
    )
