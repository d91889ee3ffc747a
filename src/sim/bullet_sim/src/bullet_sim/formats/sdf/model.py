"""Reads SDF models with their nested models into one flat description."""

from collections.abc import Iterator
from dataclasses import replace
from xml.etree.ElementTree import Element

from bullet_sim.description import ModelDescription, PluginDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import all_that_can, mistake, or_without
from bullet_sim.formats.sdf.frames import MODEL, Frames, add_model_frames, relative_to
from bullet_sim.formats.sdf.include import read_include
from bullet_sim.formats.sdf.joint import read_joint
from bullet_sim.formats.sdf.link import drop_endless_inertia, read_link
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import flag, pose

NOT_SUPPORTED = ("gripper", "urdf")


def read_model(element: Element, source: Source, inside: str = "") -> ModelDescription:
    """A `<model>`; links of nested models are named `nested::link`, as by Base::ComputeScopedName.

    FormatError if it has no name or no link.
    """
    name = element.get("name", "")
    if not name:
        raise FormatError("a <model> has no name")
    where = f"{inside}, model {name!r}" if inside else f"model {name!r}"
    for tag in NOT_SUPPORTED:
        if element.find(tag) is not None:
            source.warn_once(f"{where}: <{tag}> is not supported, left out")
    static = flag(element, "static", False)
    if static:
        drop_endless_inertia(element)
    frames = Frames(source, name)
    add_model_frames(frames, element, where)
    nested = _place(_nested_models(element, source, where), frames)
    links = all_that_can(read_link, without_twins(element, "link", where), source, where, frames)
    links += [link for model in nested for link in model.links]
    if not links:
        raise FormatError(f"{where}: a model must have at least one link")
    for model in nested:
        for link in model.links:
            frames.add(link.name, MODEL, link.pose)
    names = {link.name for link in links}
    joints = all_that_can(
        read_joint, without_twins(element, "joint", where), source, where, frames, names)
    joints += [joint for model in nested for joint in model.joints]
    return ModelDescription(
        name=name,
        pose=pose(element, where),
        static=static,
        self_collide=flag(element, "self_collide", False),
        auto_disables=flag(element, "allow_auto_disable", True),
        links=tuple(links),
        joints=tuple(joints),
        plugins=read_plugins(element) + tuple(p for model in nested for p in model.plugins),
        child_models=tuple(child for model in nested for child in model.child_models),
        child_poses={name: pose for model in nested for name, pose in model.child_poses.items()},
        lumped={child: place for model in nested for child, place in model.lumped.items()},
    )


def _nested_models(
    element: Element, source: Source, where: str
) -> Iterator[tuple[ModelDescription, str]]:
    """Nested models and the frames in which their poses are given."""
    for nested in element.findall("model"):
        model = or_without(read_model, nested, source, where)
        if model is not None:
            yield model, relative_to(nested)
    for include in element.findall("include"):
        found = read_include(include, source)
        if isinstance(found, ModelDescription):
            yield found, relative_to(include)


def _place(
    nested: Iterator[tuple[ModelDescription, str]], frames: Frames
) -> list[ModelDescription]:
    """Nested models in the outer model's frame, with scoped names."""
    placed = []
    for model, given_in in nested:
        frames.add(model.name, given_in or MODEL, model.pose)
        placed.append(_scoped(replace(model, pose=frames.in_model(model.name))))
    return placed


def _scoped(model: ModelDescription) -> ModelDescription:
    scope = f"{model.name}::"
    ends = {link.name: scope + link.name for link in model.links}
    renamed = ends | {joint.name: scope + joint.name for joint in model.joints}
    return replace(
        model,
        links=tuple(
            replace(link, name=ends[link.name], pose=model.pose * link.pose)
            for link in model.links
        ),
        joints=tuple(
            replace(
                joint,
                name=renamed[joint.name],
                parent=ends.get(joint.parent, joint.parent),
                child=ends.get(joint.child, joint.child),
                gearbox_reference_body=ends.get(joint.gearbox_reference_body, ""),
            )
            for joint in model.joints
        ),
        plugins=tuple(_with_scoped_names(plugin, renamed) for plugin in model.plugins),
        child_models=(model.name, *(scope + child for child in model.child_models)),
        child_poses={model.name: model.pose} | {
            scope + child: model.pose * pose for child, pose in model.child_poses.items()},
        lumped={
            scope + child: (ends[survivor], place)
            for child, (survivor, place) in model.lumped.items()
        },
    )


def _with_scoped_names(plugin: PluginDescription, renamed: dict[str, str]) -> PluginDescription:
    """Rename links or joints in a plugin's parameters for the outer model."""
    for parameter in plugin.element.iter():
        text = (parameter.text or "").strip()
        if text in renamed:
            parameter.text = renamed[text]
    return plugin


def without_twins(element: Element, tag: str, where: str) -> list[Element]:
    """The links or joints of an element; a second one of a name is left out, with an error line."""
    found: dict[str, Element] = {}
    for part in element.findall(tag):
        name = part.get("name", "")
        if found.setdefault(name, part) is not part:
            mistake(f"{where}: two {tag}s are named {name!r}; the second one is left out")
    return list(found.values())
