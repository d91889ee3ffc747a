"""SDF text from shapes and colours: m, rad, colours 0..1; poses are x, y, z, roll, pitch, yaw."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from racecar_description.track.painted_plane import config_text, material_text

Numbers = tuple[float, ...]
ORIGIN: Numbers = (0.0, 0.0, 0.0)
WHITE, GREY, DARK = (0.9, 0.9, 0.9), (0.6, 0.6, 0.6), (0.15, 0.15, 0.15)

DOCUMENT = '<?xml version="1.0"?>\n<sdf version="1.4">\n{body}\n</sdf>\n'


@dataclass(frozen=True)
class Part:
    """A shape that is seen and, where it is solid, touched."""

    name: str
    shape: str  # what stands in <geometry>
    pose: Numbers = ORIGIN
    colour: Numbers = GREY
    solid: bool = True
    glows: bool = False
    texture: str = ""  # URI of a model folder, with `materials` below
    material: str = ""  # its name in the script there


def box(x: float, y: float, z: float) -> str:
    return f"<box><size>{words((x, y, z))}</size></box>"


def cylinder(radius: float, length: float) -> str:
    return f"<cylinder><radius>{radius:g}</radius><length>{length:g}</length></cylinder>"


def sphere(radius: float) -> str:
    return f"<sphere><radius>{radius:g}</radius></sphere>"


def words(numbers: Iterable[float]) -> str:
    return " ".join(f"{round(number, 4) + 0.0:g}" for number in numbers)


def pose(numbers: Numbers) -> str:
    """`<pose>` of x, y, z and up to three angles; nothing where all are 0."""
    padded = (*numbers, *(0.0,) * (6 - len(numbers)))
    return f"<pose>{words(padded)}</pose>" if any(padded) else ""


def link(name: str, parts: Iterable[Part], place: Numbers = ORIGIN, mass: str = "") -> str:
    """A link; `mass` is its `<inertial>`, which things that never move need not have."""
    lines = [f'    <link name="{name}">{pose(place)}{mass}']
    for part in parts:
        if part.solid:
            lines.append(f'      <collision name="{part.name}">{_placed(part)}</collision>')
        lines.append(f'      <visual name="{part.name}">{_placed(part)}\n'
                     f"        <material>{_look(part)}</material></visual>")
    return "\n".join([*lines, "    </link>"])


def _placed(part: Part) -> str:
    return f"{pose(part.pose)}<geometry>{part.shape}</geometry>"


def _look(part: Part) -> str:
    if part.texture:
        folder = f"{part.texture}/materials"
        return (f"<script><uri>{folder}/scripts</uri><uri>{folder}/textures</uri>"
                f"<name>{part.material}</name></script>")
    colour = words((*part.colour, 1))
    glow = f"<emissive>{colour}</emissive>" if part.glows else ""
    return f"<ambient>{colour}</ambient><diffuse>{colour}</diffuse>{glow}"


def model(name: str, links: Iterable[str], place: Numbers = ORIGIN, static: int = 1) -> str:
    """A `<model>`, for a world or for `document`."""
    body = "\n".join(links)
    head = f'  <model name="{name}">{pose(place)}\n    <static>{static}</static>'
    return f"{head}\n{body}\n  </model>"


def document(body: str) -> str:
    """A whole SDF file."""
    return DOCUMENT.format(body=body)


def model_files(folder: str, text: str, description: str) -> dict[str, bytes]:
    """The two files of a model folder; paths below `models/`."""
    return {f"{folder}/model.sdf": document(text).encode(),
            f"{folder}/model.config": config_text(folder.rpartition("/")[2], description).encode()}


def material_files(folder: str, name: str, png: bytes) -> dict[str, bytes]:
    """The script and texture behind a part's `texture` and `material`."""
    return {f"{folder}/materials/scripts/{name}.material": material_text(name).encode(),
            f"{folder}/materials/textures/{name}.png": png}
