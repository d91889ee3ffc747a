"""A scene in the form that the page's 3D view needs: links with numbered meshes and poses."""

from collections.abc import Hashable
from typing import Any

from bullet_sim.description import LightDescription, Material
from bullet_sim.pose import Pose, rotate
from bullet_sim.rendering.scene import LinkShape
from bullet_sim.rendering.scene_text import SceneContent
from sim_viewer.meshes import Meshes

NOTHING = {"background": None, "ambient": [1, 1, 1, 1], "sky": False, "lights": [], "links": []}


def page_scene(content: SceneContent, meshes: Meshes, owner: Hashable = None) -> dict[str, Any]:
    """The scene as JSON data; may take a while, since files are read. Links are called
    `model::link`, or by their own name if they belong to no model. `owner`: see Meshes.shapes."""
    shapes = meshes.shapes([visuals for _, visuals in content.links.values()], owner)
    textures = meshes.texture_numbers()
    sizes = sorted({shape.plane_size for shape in shapes} - {0.0})
    links = []
    for (model, link), shape in zip(content.links, shapes, strict=True):
        pose = content.links[model, link][0]
        links.append({
            "name": f"{model}::{link}" if model else link,
            "model": model,
            "pose": pose_row(pose),
            # Where planes coincide, the larger one is hidden, as in camera images.
            "plane": sizes.index(shape.plane_size) if shape.plane_size else None,
            "parts": _parts(shape, meshes, textures),
        })
    scene = content.description
    return {"background": scene.background, "ambient": scene.ambient, "sky": scene.sky,
            "lights": [_light(light) for light in content.lights], "links": links}


def pose_row(pose: Pose) -> list[float]:
    """x, y, z in m and the quaternion x, y, z, w."""
    return [*pose.position, *pose.orientation]


def _parts(shape: LinkShape, meshes: Meshes, textures: dict[str, int]) -> list[dict[str, Any]]:
    return [{"mesh": meshes.mesh_number(part), "material": _material(part.material, textures)}
            for part in shape.parts]


def _material(material: Material, textures: dict[str, int]) -> dict[str, Any]:
    return {
        "ambient": material.ambient, "diffuse": material.diffuse, "specular": material.specular,
        "emissive": material.emissive, "shininess": material.shininess,
        "lighting": material.lighting, "texture": textures.get(material.texture),
        "texture_scale": material.texture_scale,
    }


def _light(light: LightDescription) -> dict[str, Any]:
    return {
        "type": light.type, "position": light.pose.position,
        "direction": rotate(light.pose.orientation, light.direction),
        "diffuse": light.diffuse, "specular": light.specular, "range": light.range,
        "attenuation": [light.constant, light.linear, light.quadratic],
        "cone": [light.inner_angle, light.outer_angle, light.falloff],
    }
