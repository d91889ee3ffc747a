"""Reads `<include>`: finds the model folder and its SDF file, and applies the overrides."""

from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

from bullet_sim.description import LightDescription, ModelDescription
from bullet_sim.errors import FormatError, ResourceNotFound, SimulationError
from bullet_sim.formats.mistakes import mistake, reading
from bullet_sim.formats.sdf.link import drop_endless_inertia
from bullet_sim.formats.sdf.scene import read_light
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.source import NEWEST_SDF, Source, sdf_version
from bullet_sim.formats.xml_values import child_text, flag, pose, read_xml_file

Found = ModelDescription | LightDescription
MANIFESTS = ("model.config", "manifest.xml")
DEEPEST = 30  # files that include each other
MOST_FILES = 2000  # of one world: a few files that include each other twice make a million


def read_include(include: Element, source: Source) -> Found | None:
    """The included model or light; None, with one error line, if it cannot be read."""
    uri = child_text(include, "uri")
    if len(source.files) >= MOST_FILES:
        source.warn_once(f"more than {MOST_FILES} <include>s; the rest is left out", "includes")
        return None
    try:
        return _read(include, uri, source)
    except ResourceNotFound as error:
        mistake(f"<include>: {error}; going on without it")
    except SimulationError as error:
        mistake(f"<include> of {uri}: {error}; going on without it")
    return None


def _read(include: Element, uri: str, source: Source) -> Found:
    if not uri:
        raise FormatError("no <uri>; write <uri>model://NAME</uri>")
    file = model_file(source.resources.resolve(uri, source.folder))
    if file in source.including:
        raise FormatError(f"{file} includes itself")
    if len(source.including) > DEEPEST:
        raise FormatError(f"models that include models more than {DEEPEST} deep")
    source.files.append(file)
    root = read_xml_file(file)
    inner = source.entering(file).of_root(root)
    if flag(include, "static", False):
        drop_endless_inertia(root)
    light = root.find("light")
    with reading(str(file)):
        if root.tag != "robot" and root.find("model") is None and light is not None:
            found = read_light(light)
        else:
            found = source.read_root(root, inner)
    return _overridden(found, include)


def _overridden(found: Found, include: Element) -> Found:
    """Apply the include's own name and pose; for a model also its static flag and plugins."""
    where = f"<include> of {child_text(include, 'uri')}"
    found = replace(found, name=child_text(include, "name", found.name),
                    pose=pose(include, where, found.pose))
    if isinstance(found, LightDescription):
        return found
    return replace(found, static=flag(include, "static", found.static),
                   plugins=found.plugins + read_plugins(include))


def model_file(found: Path) -> Path:
    """The file to read in a model folder: the newest supported SDF named by its model.config.

    ResourceNotFound if there is none, FormatError for a model.config that names none.
    """
    if found.is_file():
        return found
    for manifest in MANIFESTS:
        if (found / manifest).is_file():
            return _chosen(found / manifest)
    if (found / "model.sdf").is_file():
        return found / "model.sdf"
    raise ResourceNotFound(f"model.config of {found.name}", [str(found)])


def _chosen(manifest: Path) -> Path:
    root = read_xml_file(manifest)
    choices = [
        (sdf_version(sdf.get("version", "")), (sdf.text or "").strip()) for sdf in root.iter("sdf")
    ]
    if not choices:
        raise FormatError(f"{manifest} names no <sdf> file")
    known = [choice for choice in choices if choice[0] <= NEWEST_SDF]
    name = max(known)[1] if known else min(choices)[1]
    file = manifest.parent / name
    if not file.is_file():
        raise ResourceNotFound(f"{name}, named by {manifest},", [str(manifest.parent)])
    return file
