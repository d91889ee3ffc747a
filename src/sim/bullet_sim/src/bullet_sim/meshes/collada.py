"""COLLADA (.dae) files, read as by Gazebo: the unit scales, up_axis is ignored.

Its ColladaLoader.cc, Load, multiplies by the file's metres per unit and never rotates the model,
whatever up_axis says; models for Gazebo are made accordingly, so a Y_UP file is not rotated.
Skins are drawn in their bind pose.
"""

import io
import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from bullet_sim.description import Material, Rgba
from bullet_sim.errors import FormatError
from bullet_sim.files import find_beside
from bullet_sim.meshes.part import MeshPart, NamedPart, shaded
from bullet_sim.meshes.smoothing import smooth_shaded

SHADED = ("emission", "ambient", "diffuse", "specular", "shininess", "reflective", "reflectivity",
          "transparent", "transparency", "index_of_refraction")
INSTANCES = ("node", "geometry", "controller", "camera", "light")
UNUSED = "UNUSED"  # a meaning that pycollada does not know


def without_dangling(root: Any) -> list[str]:
    """Change a document, lxml's root element, so that all its references lead somewhere.

    pycollada leaves out the geometry as well where one does not; Gazebo draws it, without texture
    or material.

    Returns what was missing that would be seen, such as `material 'red'`, each once.
    """
    missing: dict[str, None] = {}
    images = _ids(root, "image")
    for effect in _all(root, "effect"):
        _mend_effect(effect, images, missing)
    effects = {effect.get("id") for effect in _all(root, "effect") if _is_common(effect)}
    for material in list(_all(root, "material")):
        if (wanted := _target(material, "{*}instance_effect", "url")) not in effects:
            missing[f"effect {wanted!r}"] = None
            material.getparent().remove(material)
    _drop(root, "instance_material", "target", _ids(root, "material"), missing, "material")
    for mesh in _all(root, "mesh"):
        _mend_inputs(mesh, missing)
    for kind in INSTANCES:
        seen = missing if kind in ("node", "geometry", "controller") else {}
        _drop(root, f"instance_{kind}", "url", _ids(root, kind), seen, kind)
    scenes = [scene.get("id") for scene in _all(root, "visual_scene")]
    for instance in _all(root, "instance_visual_scene"):
        if scenes and instance.get("url", "")[1:] not in scenes:
            missing[f"visual_scene {instance.get('url', '')[1:]!r}"] = None
            instance.set("url", f"#{scenes[0]}")
    return list(missing)


def _all(root: Any, tag: str) -> Any:
    return root.iter(f"{{*}}{tag}")


def _ids(root: Any, tag: str) -> set[str]:
    return {element.get("id") for element in _all(root, tag)}


def _target(element: Any, path: str, attribute: str) -> str:
    found = element.find(path)
    return "" if found is None else found.get(attribute, "").removeprefix("#")


def _drop(root: Any, tag: str, attribute: str, known: set[str], missing: dict[str, None],
          kind: str) -> None:
    for element in list(_all(root, tag)):
        wanted = element.get(attribute, "")
        if not wanted.startswith("#") or wanted[1:] not in known:
            missing[f"{kind} {wanted.removeprefix('#')!r}"] = None
            element.getparent().remove(element)


def _is_common(effect: Any) -> bool:
    """Whether pycollada can read it."""
    return any(effect.find(f"{{*}}profile_COMMON/{{*}}technique/{{*}}{shader}") is not None
               for shader in ("phong", "lambert", "blinn", "constant"))


def _mend_effect(effect: Any, images: set[str], missing: dict[str, None]) -> None:
    surfaces, samplers = set(), set()
    for kind, path, known, found in (
            ("image", "surface/{*}init_from", images, surfaces),
            ("surface", "sampler2D/{*}source", surfaces, samplers)):
        for parameter in list(_all(effect, "newparam")):
            source = parameter.find("{*}" + path)
            if parameter.find("{*}" + path.partition("/")[0]) is None:
                continue
            wanted = "" if source is None else source.text
            if wanted in known:
                found.add(parameter.get("sid"))
            else:
                missing[f"{kind} {wanted!r}"] = None
                parameter.getparent().remove(parameter)
    for texture in list(_all(effect, "texture")):
        if texture.get("texture") not in samplers | images:
            missing[f"texture {texture.get('texture', '')!r}"] = None
            parent = texture.getparent()
            away = parent if parent.tag.rpartition("}")[2] in SHADED else texture
            away.getparent().remove(away)


def _mend_inputs(mesh: Any, missing: dict[str, None]) -> None:
    """Vertices are needed; a missing source of anything else is replaced, as its indices stay."""
    arrays = _ids(mesh, "source")
    sources = arrays | _ids(mesh, "vertices")
    for given in list(_all(mesh, "input")):
        wanted = given.get("source", "")[1:]
        if wanted in sources or given.get("semantic") in ("VERTEX", "POSITION"):
            continue
        missing[f"source {wanted!r}"] = None
        if given.getparent().tag.endswith("}vertices"):
            given.getparent().remove(given)
        else:
            given.set("semantic", UNUSED)
            given.set("source", f"#{next(iter(arrays), '')}")


_log = logging.getLogger(__name__)

ZIP = b"PK"
MOST_NAMED = 5  # missing things, in a warning
MOST_NODES = 20_000  # counted as often as they are instanced: ten lines can ask for millions
MOST_TRIANGLES = 4_000_000


def read_collada(path: Path, split: bool) -> list[NamedPart]:
    """One part per primitive, named after its scene node.

    FormatError for more than MOST_NODES nodes or MOST_TRIANGLES triangles, and for an archive.
    """
    document = _document(path)
    if document.scene is None:
        return []
    unit = document.assetInfo.unitmeter or 1.0
    root = np.diag([unit, unit, unit, 1.0])
    folder = path.parent
    parts: list[NamedPart] = []
    left, triangles = iter(range(MOST_NODES)), 0
    for node in document.scene.nodes:
        for name, instance, matrix in _instances(node, root, "", left):
            for part in _parts(instance, matrix, folder):
                parts.append((name, part))
                triangles += len(part.faces)
                if triangles > MOST_TRIANGLES:
                    raise FormatError(f"it has more than {MOST_TRIANGLES} triangles; export it "
                                      "with fewer")
    return parts


def _document(path: Path) -> Any:
    """The document, with one warning if it refers to things that it lacks."""
    import collada
    from lxml import etree

    content = path.read_bytes()
    if content.startswith(ZIP):  # pycollada would unpack it, whatever its size
        raise FormatError("it is a ZIP archive; unpack it and name the .dae inside")
    if b"<!ENTITY" in content.replace(b"\0", b""):  # any encoding; they can grow without limit
        raise FormatError("it declares entities; write their text where it is used")
    try:
        root = etree.fromstring(content, etree.XMLParser(huge_tree=True))
    except etree.XMLSyntaxError as error:
        raise FormatError(f"it is not well-formed XML: {error}") from None
    if missing := without_dangling(root):
        _log.warning("mesh %s: it refers to what is not in it: %s; drawn without", path,
                     ", ".join(missing[:MOST_NAMED]) + (", ..." if missing[MOST_NAMED:] else ""))
        content = etree.tostring(root)
    ignored = [collada.common.DaeUnsupportedError, collada.common.DaeBrokenRefError]
    return collada.Collada(io.BytesIO(content), ignore=ignored)


def _instances(node: Any, matrix: np.ndarray, name: str, left: Iterator[int],
               ) -> Iterator[tuple[str, Any, np.ndarray]]:
    """Every geometry or controller of a tree, with its node's name and its matrix in the mesh.

    `left` yields once for each node still allowed; FormatError when it is exhausted.
    """
    import collada.scene as tree

    if next(left, None) is None:
        raise FormatError(f"its scene has more than {MOST_NODES} nodes, each counted as often as "
                          "it is instanced; export it as one mesh")
    if isinstance(node, tree.GeometryNode | tree.ControllerNode):
        yield name, node, matrix
        return
    if isinstance(node, tree.NodeNode):
        children, matrix = [node.node], matrix
    elif isinstance(node, tree.Node):
        children, matrix = node.children, matrix @ node.matrix
        name = (node.xmlnode.get("name") if node.xmlnode is not None else None) or name
    else:
        return
    for child in children:
        yield from _instances(child, matrix, name, left)


def _parts(instance: Any, matrix: np.ndarray, folder: Path) -> Iterator[MeshPart]:
    geometry = getattr(instance, "geometry", None)
    if geometry is None:  # a controller: its skin, placed by the bind shape matrix
        skin = instance.controller
        geometry = skin.geometry
        matrix = matrix @ np.asarray(skin.bind_shape_matrix).reshape(4, 4)
    effects = {node.symbol: getattr(node.target, "effect", None) for node in instance.materials}
    for primitive in geometry.primitives:
        triangles = _triangles(primitive)
        if triangles is None or triangles.vertex is None or len(triangles) == 0:
            continue
        effect = effects.get(primitive.material)
        material = None if effect is None else _material(effect, folder)
        yield _part(triangles, matrix, material)


def _triangles(primitive: Any) -> Any:
    import collada

    if isinstance(primitive, collada.triangleset.TriangleSet):
        return primitive
    if isinstance(primitive, collada.polylist.Polylist):  # polygons are a kind of polylist
        return primitive.triangleset()
    return None  # lines have no surface


def _part(triangles: Any, matrix: np.ndarray, material: Material | None) -> MeshPart:
    """Positions, normals and image coordinates have separate indices."""
    count = len(triangles.vertex_index) * 3
    faces = np.arange(count, dtype=np.uint32).reshape(-1, 3)
    mirrored = np.linalg.det(matrix[:3, :3]) < 0
    order = (faces[:, ::-1] if mirrored else faces).reshape(-1)

    def of_corners(values: np.ndarray, indices: np.ndarray) -> np.ndarray:
        return values[indices].reshape(count, -1)[order]

    vertices = of_corners(triangles.vertex, triangles.vertex_index)
    vertices = vertices @ matrix[:3, :3].T + matrix[:3, 3]
    uv = None
    if len(triangles.texcoordset):
        uv = of_corners(triangles.texcoordset[0], triangles.texcoord_indexset[0])
        uv = uv[:, :2].astype(np.float32)
    flattens = not np.linalg.det(matrix[:3, :3])  # it says nothing about normals then
    if triangles.normal is None or triangles.normal_index is None or flattens:
        return smooth_shaded(vertices, faces, uv, material)
    normals = of_corners(triangles.normal, triangles.normal_index)
    normals = normals @ np.linalg.inv(matrix[:3, :3])
    return shaded(vertices, normals, faces, uv, material)


def _material(effect: Any, folder: Path) -> Material:
    """Without a specular colour: models made for Gazebo rely on having none."""
    texture = _texture(effect.diffuse, folder)
    diffuse = _colour(effect.diffuse, (1.0, 1.0, 1.0, 1.0) if texture else (0.7, 0.7, 0.7, 1.0))
    return Material(
        # Exporters leave ambient black or white whatever the surface is.
        ambient=(*diffuse[:3], 1.0),
        diffuse=(*diffuse[:3], _opacity(effect)),
        emissive=_colour(effect.emission, (0.0, 0.0, 0.0, 1.0)),
        texture=texture,
    )


def _colour(value: Any, default: Rgba) -> Rgba:
    if not isinstance(value, tuple | list) or len(value) < 3:
        return default
    red, green, blue = (float(channel) for channel in value[:3])
    return (red, green, blue, 1.0)


def _opacity(effect: Any) -> float:
    """COLLADA's two conventions; for opaque surfaces exporters often write what means invisible."""
    import collada.material

    colour = effect.transparent if isinstance(effect.transparent, tuple | list) else None
    amount = effect.transparency if isinstance(effect.transparency, float | int) else 1.0
    if colour is None or len(colour) < 4:
        return 1.0
    if effect.opaque_mode == collada.material.OPAQUE_MODE.RGB_ZERO:
        red, green, blue = colour[:3]
        opacity = 1 - amount * (0.212671 * red + 0.71516 * green + 0.072169 * blue)
    else:
        opacity = amount * colour[3]
    return float(opacity) if 0 < opacity < 1 else 1.0


def _texture(value: Any, folder: Path) -> str | None:
    """Absolute path of a diffuse map, searched as written and next to the file; else a warning."""
    image = getattr(getattr(getattr(value, "sampler", None), "surface", None), "image", None)
    written = getattr(image, "path", None)
    if not written:
        return None
    name = written.removeprefix("file://")
    if path := find_beside(name, folder):
        return str(path.resolve())
    _log.warning("a COLLADA mesh in %s: texture %s not found there; drawn without it", folder, name)
    return None
