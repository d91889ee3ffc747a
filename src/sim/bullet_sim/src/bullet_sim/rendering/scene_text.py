"""A scene as JSON text and back: the visible content, for drawing in another process.

Every description is an object with its class's name under "is" and its fields, except plugins:

    {"scene": {"is": "SceneDescription", "background": [...], ...},
     "lights": [{"is": "LightDescription", "type": "directional", "pose": {"is": "Pose", ...}}],
     "links": [{"model": "robot", "link": "base", "pose": {...}, "visuals": [{"is": "Visual",
         "geometry": {"is": "Mesh", "path": "/...", "scale": [1, 1, 1]}, "material": {...}}]}]}

Files are given by absolute path; a reader leaves out textures that are not files.
"""

import json
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from bullet_sim import description
from bullet_sim.description import LightDescription, SceneDescription, Visual
from bullet_sim.errors import FormatError
from bullet_sim.pose import Pose
from bullet_sim.rendering.scene import LinkKey, Scene

_CLASSES = {kind.__name__: kind for kind in (
    Pose, description.Box, description.Cylinder, description.Fog, description.Heightmap,
    description.ImageExtrusion, LightDescription, description.Material, description.Mesh,
    description.Plane, description.Polyline, SceneDescription, description.Sphere,
    description.Strip, description.TerrainLayer, Visual)}
_LEFT_OUT = ("plugins",)


@dataclass(frozen=True)
class SceneContent:
    """The content of a text; poses are those at the time of writing."""

    description: SceneDescription
    lights: tuple[LightDescription, ...]
    links: dict[LinkKey, tuple[Pose, tuple[Visual, ...]]]


def scene_to_text(scene: Scene) -> str:
    """The current scene, in one line."""
    links = [{"model": model, "link": link, "pose": _plain(scene.nodes[model, link].pose),
              "visuals": _plain(visuals)} for (model, link), visuals in scene.visuals.items()]
    return json.dumps({"scene": _plain(scene.description),
                       "lights": _plain(tuple(scene.lights.values())), "links": links},
                      separators=(",", ":"))


def scene_from_text(text: str) -> SceneContent:
    """The content of a text from `scene_to_text`; FormatError for other texts."""
    try:
        read = json.loads(text, object_hook=_object)
        return SceneContent(read["scene"], _tuples(read["lights"]), {
            (link["model"], link["link"]): (link["pose"], _tuples(link["visuals"]))
            for link in read["links"]})
    except (ValueError, KeyError, TypeError) as error:
        raise FormatError(f"this is not a scene: {error!r}") from None


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        kept = {field.name: _plain(getattr(value, field.name)) for field in fields(value)
                if field.name not in _LEFT_OUT}
        return {"is": type(value).__name__, **kept}
    if isinstance(value, (tuple, list)):
        return [_plain(one) for one in value]
    return value


def _object(read: dict[str, Any]) -> Any:
    if "is" not in read:
        return read
    kind = _CLASSES[read.pop("is")]
    return kind(**{name: _tuples(value) for name, value in read.items()})


def _tuples(value: Any) -> Any:
    """Lists as tuples, as in descriptions, so that equal ones are one key."""
    return tuple(_tuples(one) for one in value) if isinstance(value, list) else value
