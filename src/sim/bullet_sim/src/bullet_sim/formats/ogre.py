"""Parses the part of OGRE's material scripts used by Gazebo models: first pass, first texture."""

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from types import MappingProxyType

from bullet_sim.description import Material, Rgba
from bullet_sim.errors import FormatError
from bullet_sim.formats.resources import DATA_FOLDER


@cache
def named_materials() -> dict[str, Material]:
    """All materials by full name."""
    table = tomllib.loads((DATA_FOLDER / "gazebo_materials.toml").read_text(encoding="utf-8"))
    return {name: Material(**{key: tuple(value) if isinstance(value, list) else value
                              for key, value in entry.items()}) for name, entry in table.items()}


# An unclosed comment is the rest of the file: otherwise each /* in it would be tried again.
COMMENT = re.compile(r"//[^\n]*|/\*(?:.*?\*/|.*\Z)", re.DOTALL)
WORD = re.compile(r'"([^"]*)"|(\S+)')
SECTIONS = ("technique", "pass", "texture_unit")  # only the first of each counts


@dataclass
class ScriptMaterial:
    """A material as written: its arguments by keyword."""

    name: str
    parent: str | None = None
    imports: tuple[str, ...] = ()  # names of the scripts from which its script imports
    values: dict[str, list[str]] = field(default_factory=dict)


def parse_script(text: str) -> dict[str, ScriptMaterial]:
    """All materials of a script by name. FormatError for unbalanced braces."""
    statements = _statements(text)
    materials: dict[str, ScriptMaterial] = {}
    imports: list[str] = []
    for words in statements:
        if words == ["{"]:
            _skip_block(statements)
        elif words[0] == "import":
            imports.append(words[-1])
        elif words[0] == "material" and len(words) > 1:
            material = _header(words[1:])
            if next(statements, None) != ["{"]:
                raise FormatError(f"material {material.name!r}: expected '{{' after its name")
            material.imports = tuple(imports)
            _read_block(statements, material, set())
            materials[material.name] = material
    return materials


def to_material(
    name: str,
    materials: dict[str, ScriptMaterial],
    find_texture: Callable[[str], str | None],
    ready: Mapping[str, Material] = MappingProxyType({}),
) -> Material:
    """The description of a parsed material, with what it inherits, lastly from one of `ready`.

    FormatError for an unknown parent and for invalid numbers.
    """
    values, oldest = _inherited(name, materials)
    shown = ready.get(oldest or "", Material())
    specular, shininess = _specular(name, values.get("specular"), shown)
    texture = _texture_name(values)
    scale = _numbers(name, "scale", values.get("scale", ["1", "1"])[:2])
    return Material(
        ambient=_colour(name, "ambient", values, shown.ambient),
        diffuse=_colour(name, "diffuse", values, shown.diffuse),
        specular=specular,
        emissive=_colour(name, "emissive", values, shown.emissive),
        shininess=shininess,
        texture=find_texture(texture) if texture else shown.texture,
        texture_scale=(scale[0], scale[-1]),
        lighting=values["lighting"][0] != "off" if "lighting" in values else shown.lighting,
        double_sided=values.get("cull_hardware") == ["none"],
    )


def _texture_name(values: dict[str, list[str]]) -> str | None:
    """Name of the image; a material that inherits may replace it by an alias."""
    alias, substitute = values.get("texture_alias"), values.get("set_texture_alias", [])
    if len(substitute) > 1 and (alias is None or alias[0] == substitute[0]):
        return substitute[1]
    return values["texture"][0] if "texture" in values else None


def _statements(text: str) -> Iterator[list[str]]:
    """Lines as lists of words; a brace is a statement by itself."""
    spread = re.sub(r"([{}])", r"\n\1\n", COMMENT.sub("", text))
    for line in spread.splitlines():
        words = [quoted or bare for quoted, bare in WORD.findall(line)]
        if words:
            yield words


def _header(words: list[str]) -> ScriptMaterial:
    name, _, rest = " ".join(words).partition(":") if ":" in words else (" ".join(words), "", "")
    return ScriptMaterial(name.strip(), rest.strip() or None)


def _read_block(statements: Iterator[list[str]], material: ScriptMaterial, seen: set[str]) -> None:
    """Read statements up to the closing brace; `seen` holds the kinds of section already read."""
    pending: list[str] | None = None
    for words in statements:
        if words == ["}"]:
            _keep(material, pending)
            return
        if words == ["{"]:
            kind = pending[0] if pending else ""
            pending = None
            if kind in SECTIONS and kind not in seen:
                seen.add(kind)
                _read_block(statements, material, seen)
            else:
                _skip_block(statements)
        else:
            _keep(material, pending)
            pending = words
    raise FormatError(f"material {material.name!r}: a '}}' is missing")


def _keep(material: ScriptMaterial, words: list[str] | None) -> None:
    if words and words[0] not in SECTIONS and len(words) > 1:
        material.values[words[0]] = words[1:]


def _skip_block(statements: Iterator[list[str]]) -> None:
    depth = 1
    for words in statements:
        depth += {"{": 1, "}": -1}.get(words[0], 0)
        if depth == 0:
            return


def _inherited(
    name: str, materials: dict[str, ScriptMaterial]
) -> tuple[dict[str, list[str]], str | None]:
    """Keywords with those of all ancestors, and the oldest one's parent, not in `materials`."""
    chain: list[str] = []
    current: str | None = name
    while current in materials and current not in chain:
        chain.append(current)
        current = materials[current].parent
    values: dict[str, list[str]] = {}
    for ancestor in reversed(chain):
        values.update(materials[ancestor].values)
    return values, current


def _colour(name: str, keyword: str, values: dict[str, list[str]], default: Rgba) -> Rgba:
    words = values.get(keyword)
    if words is None or words == ["vertexcolour"]:
        return default
    return _rgba(name, keyword, words)


def _specular(name: str, words: list[str] | None, shown: Material) -> tuple[Rgba, float]:
    """Colour and shininess; OGRE writes the latter as the last number, after a colour of 3 or 4."""
    if words is None or "vertexcolour" in words:
        return shown.specular, shown.shininess
    if len(words) < 4:
        return _rgba(name, "specular", words), 0.0
    return _rgba(name, "specular", words[:-1]), _numbers(name, "specular", words[-1:])[0]


def _rgba(name: str, keyword: str, words: list[str]) -> Rgba:
    values = _numbers(name, keyword, words)
    if len(values) not in (3, 4):
        raise FormatError(f"material {name!r}: {keyword} {' '.join(words)!r} is not a colour")
    return (*values, 1.0)[:4]


def _numbers(name: str, keyword: str, words: list[str]) -> list[float]:
    try:
        return [float(word) for word in words]
    except ValueError:
        raise FormatError(
            f"material {name!r}: {keyword} {' '.join(words)!r} has a word that is not a number"
        ) from None
