"""Reads SDF `<material>`: colours, named materials and OGRE scripts found through their URIs."""

import os.path
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

from bullet_sim.description import Material
from bullet_sim.errors import FormatError, ResourceNotFound
from bullet_sim.files import check_file
from bullet_sim.formats.ogre import ScriptMaterial, named_materials, parse_script, to_material
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import child_text, colour, flag, number

BUILTIN_SCRIPT = "media/materials/scripts/gazebo.material"
PBR_WORKFLOWS = ("metal", "specular")
LARGEST_SCRIPT = 4 * 2**20  # bytes
COLOURS = ("ambient", "diffuse", "specular", "emissive")


def read_material(element: Element, source: Source, where: str) -> Material | None:
    """A visual's material; None if there is no known element."""
    named = _scripted(element, source, where)
    written = [name for name in COLOURS if child_text(element, name)]
    start = named or Material()
    changes = {name: colour(element, name, getattr(start, name), where) for name in written}
    if not flag(element, "lighting", start.lighting):
        changes["lighting"] = False
    if flag(element, "double_sided", start.double_sided):
        changes["double_sided"] = True
    if child_text(element, "shininess"):
        changes["shininess"] = number(element, "shininess", 0.0, where)
    albedo = _albedo_map(element, source, where)
    if albedo:
        changes["texture"] = albedo
    return replace(start, **changes) if changes else named


def _albedo_map(element: Element, source: Source, where: str) -> str | None:
    """The colour texture of a physically based material; its other maps are not supported."""
    for workflow in PBR_WORKFLOWS:
        uri = child_text(element, f"pbr/{workflow}/albedo_map")
        if uri:
            try:
                return str(source.resources.resolve(uri, source.folder))
            except ResourceNotFound as error:
                source.warn_once(f"{where}: albedo_map {error}; drawn without it", about=uri)
    return None


def _scripted(element: Element, source: Source, where: str) -> Material | None:
    script = element.find("script")
    if script is None:
        name, uris = (element.text or "").strip(), []
    else:
        name = child_text(script, "name") or (script.text or "").strip()
        uris = [(uri.text or "").strip() for uri in script.findall("uri")]
    if not name or name == "__default__":
        return None
    return find_material(name, [uri for uri in uris if uri], source, where)


def find_material(name: str, uris: list[str], source: Source, where: str) -> Material | None:
    """A material from the scripts at `uris`, Gazebo's own materials, or a media folder."""
    own = [uri for uri in uris if not uri.endswith(BUILTIN_SCRIPT)]
    places, missing = _folders_and_scripts(own, source)
    found = _in_scripts(name, places, source)
    if found is None:
        found = named_materials().get(name)
    if found is None:
        media = [path / "media/materials/scripts" for path in source.resources.resource_paths]
        found = _in_scripts(name, [folder for folder in media if folder.is_dir()], source)
    if found is None:
        searched = ", ".join([*(str(place) for place in places), *missing]) or "Gazebo's own names"
        message = f"{where}: material {name!r} not found, default taken (searched: {searched})"
        source.warn_once(message, about=f"material {name}")
    return found


def _folders_and_scripts(uris: list[str], source: Source) -> tuple[list[Path], list[str]]:
    places, missing = [], []
    for uri in uris:
        try:
            places.append(source.resources.resolve(uri, source.folder))
        except ResourceNotFound as error:
            missing.append(str(error))
    return places, missing


def _in_scripts(name: str, places: list[Path], source: Source) -> Material | None:
    parsed: dict[str, ScriptMaterial] = {}
    home: dict[str, Path] = {}  # material -> folder of its script
    scripts = _scripts_in(places)
    for script in scripts:
        for material in _parsed(script, source).values():
            parsed.setdefault(material.name, material)
            home.setdefault(material.name, script.parent)
        for imported in _imports(script, source):
            if imported not in scripts:
                scripts.append(imported)
    if name not in parsed:
        return None
    folders = [*(place for place in places if place.is_dir()), home[name],
               home[name].parent / "textures"]
    try:
        return to_material(
            name, parsed, lambda file: _texture(file, folders, name, source), named_materials())
    except FormatError as error:
        source.warn_once(f"{home[name]}: {error}")
        return None


def _scripts_in(places: list[Path]) -> list[Path]:
    found: list[Path] = []
    for place in places:
        found += sorted(place.glob("*.material")) if place.is_dir() else [place]
    return found


def _imports(script: Path, source: Source) -> list[Path]:
    """Scripts named in a script's `import … from FILE`, next to it."""
    names = {name for material in _parsed(script, source).values() for name in material.imports}
    return [script.parent / name for name in sorted(names)
            if os.path.isfile(script.parent / name)]


def _parsed(script: Path, source: Source) -> dict[str, ScriptMaterial]:
    if script not in source.scripts:
        try:
            check_file(script, LARGEST_SCRIPT)
            text = script.read_text(encoding="utf-8", errors="replace")
            source.scripts[script] = parse_script(text)
        except (FormatError, OSError) as error:
            source.warn_once(f"material script {script}: {error}")
            source.scripts[script] = {}
    return source.scripts[script]


def _texture(file: str, folders: list[Path], name: str, source: Source) -> str | None:
    for folder in folders:
        if os.path.isfile(folder / file):  # Path.is_file raises for a name that is too long
            return str((folder / file).resolve())
    searched = ", ".join(dict.fromkeys(str(folder) for folder in folders))
    source.warn_once(f"material {name!r}: texture {file} not found (searched: {searched})")
    return None
