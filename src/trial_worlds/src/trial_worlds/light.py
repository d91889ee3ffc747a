"""A copy of a world, with its models, in brighter or dimmer light.

The renderer, like Gazebo's, clips the light on a surface at 1 before multiplying the texture by it,
and our worlds' light is at that bound: more light would change nothing on the road. So a brighter
light is simulated by brighter textures, up to white, where a camera saturates.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import cv2
import numpy as np

from bullet_sim.formats.resources import Resources
from trial_worlds.errors import WorldError

MODEL = "model://"


def write_lit_world(world: Path, models: Path, factor: float, folder: Path) -> Path:
    """Write FOLDER/<the world's name> with its light times `factor`; returns that file.

    `models` is where the world's own models are: copies of them with brighter textures go to
    FOLDER/models if the factor is above 1. Raises WorldError if the file is not a world.
    """
    folder.mkdir(parents=True, exist_ok=True)
    try:
        tree = ElementTree.parse(world)
        sun = ElementTree.parse(Resources.from_environment().resolve(f"{MODEL}sun/model.sdf"))
    except (OSError, ElementTree.ParseError) as error:
        raise WorldError(
            f"{world}: no world in which the light could be changed: {error}") from error
    scale_light(tree.getroot(), sun.getroot().find("light"), factor)
    shutil.rmtree(folder / "models", ignore_errors=True)
    if factor > 1:
        for name in _included(tree.getroot()):
            if (models / name).is_dir():
                _copy_brighter(models / name, folder / "models" / name, factor)
    tree.write(folder / world.name, encoding="unicode", xml_declaration=True)
    return folder / world.name


def scale_light(root: Element, sun: Element, factor: float) -> None:
    """Scale the world's ambient light and that of `sun`, which replaces the included sun."""
    world = root.find("world")
    for ambient in world.findall("scene/ambient"):
        _scale(ambient, factor)
    for number, child in enumerate(world):
        if child.tag == "include" and child.findtext("uri", "").strip() == f"{MODEL}sun":
            world[number] = ElementTree.fromstring(ElementTree.tostring(sun))
    for diffuse in world.findall("light/diffuse"):
        _scale(diffuse, factor)


def _scale(colour: Element, factor: float) -> None:
    """Scale red, green and blue; a fourth number, opacity, is kept."""
    values = [float(word) for word in colour.text.split()]
    scaled = [value * factor for value in values[:3]] + values[3:]
    colour.text = " ".join(f"{value:.6g}" for value in scaled)


def _included(root: Element) -> list[str]:
    """Names of the models that a world includes."""
    uris = [element.text.strip() for element in root.findall("world/include/uri")]
    return [uri.removeprefix(MODEL) for uri in uris if uri.startswith(MODEL)]


def _copy_brighter(model: Path, copy: Path, factor: float) -> None:
    shutil.copytree(model, copy)
    for path in copy.glob("materials/textures/*.png"):
        image = cv2.imread(str(path))
        cv2.imwrite(str(path), np.clip(image * factor, 0, 255).round().astype(np.uint8))
