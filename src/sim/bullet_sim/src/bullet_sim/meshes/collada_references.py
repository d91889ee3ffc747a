"""Takes out of a COLLADA document what refers to something that is not in it.

pycollada leaves out the geometry as well then; Gazebo draws it, without texture or material.
"""

from typing import Any

SHADED = ("emission", "ambient", "diffuse", "specular", "shininess", "reflective", "reflectivity",
          "transparent", "transparency", "index_of_refraction")
INSTANCES = ("node", "geometry", "controller", "camera", "light")
UNUSED = "UNUSED"  # a meaning that pycollada does not know


def without_dangling(root: Any) -> list[str]:
    """Change a document, lxml's root element, so that all its references lead somewhere.

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
