"""Writes data/models, which is not committed, from data/props: plain bodies of one link.

CMakeLists.txt and scripts/setup.sh run it, setup.py for pip, docker/entrypoint.sh for a container
over the host's source, and conftest.py for the tests. It imports nothing but the standard library,
since pip runs it before anything is installed.

A table of data/props/*.toml is a model. Its keys (SI units):
  name        the model's name if it is not that of the folder
  like, paint copies another model's table, except its name, and changes its first part's look
  static, mass (1), link ("link"), pose and link_pose [x, y, z(, roll, pitch, yaw)], as in SDF
  size        [x, y, z], m, of the box around all solid parts (around all parts if none is)
  ordinary    the size is an ordinary one of its kind; without it, it is that of the model of this
              name in Gazebo's database (gazebo_models)
  parts       list of {box = [x, y, z]}, {cylinder = [radius, length]}, {sphere = radius},
              {squares = [columns, rows, side]} (the black half of a checkerboard) or {digit = n}
              (on the four sides of a cube of 0.8 m); at = [x, y, z(, roll, pitch, yaw)] in the
              link, look = a Gazebo material or [r, g, b], solid / seen = false for no collision /
              no visual
or
  by_hand     the file of data/props that is the model's SDF, as it is
  description what model.config says of it
"""

import math
import shutil
import tomllib
import uuid
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

DATA = Path(__file__).resolve().parent / "data"
SOURCE = "bullet_sim/props.py from data/props"
SHAPES = ("box", "cylinder", "sphere")
FACES = ((0.4, 0.0, 0.0), (0.0, 0.4, 90.0), (-0.4, 0.0, 180.0), (0.0, -0.4, 270.0))
# The seven bars of a digit: across, up (of half the digit's width and height), whether horizontal.
BARS = {"a": (0, 2, True), "b": (1, 1, False), "c": (1, -1, False), "d": (0, -2, True),
        "e": (-1, -1, False), "f": (-1, 1, False), "g": (0, 0, True)}
DIGITS = {1: "bc", 2: "abged", 3: "abgcd", 4: "fgbc", 5: "afgcd", 6: "afgecd", 7: "abc",
          8: "abcdefg", 9: "abcdfg"}


def read_props(folder: Path = DATA / "props") -> dict[str, dict]:
    """All tables by model, with `like` replaced and each part made of plain shapes."""
    tables = {}
    for path in sorted(folder.glob("*.toml")):
        tables |= tomllib.loads(path.read_text(encoding="utf-8"))
    return {name: _complete(table, tables) for name, table in tables.items()}


def _complete(table: dict, tables: dict[str, dict]) -> dict:
    if "by_hand" in table:
        return table
    if "like" in table:
        model = {key: tables[table["like"]][key] for key in tables[table["like"]] if key != "name"}
        first = {**model["parts"][0], "look": table["paint"]}
        table = {**model, **table, "parts": [first, *model["parts"][1:]]}
    return {**table, "parts": [plain for part in table["parts"] for plain in _plain(part)]}


def _plain(part: dict) -> list[dict]:
    if "digit" in part:
        return [{**_bar(bar, face), "look": "Gazebo/FlatBlack", "solid": False}
                for face in FACES for bar in DIGITS[part["digit"]]]
    if "squares" in part:
        columns, rows, side = part["squares"]
        return [{"box": [side, side, 0.001], "look": part["look"], "solid": False,
                 "at": [round((i - (columns - 1) / 2) * side, 6),
                        round((j - (rows - 1) / 2) * side, 6), part["at"][2]]}
                for i in range(columns) for j in range(rows) if (i + j) % 2 == 0]
    return [part]


def _bar(bar: str, face: tuple[float, float, float]) -> dict:
    across, up, lies = BARS[bar]
    x, y, angle_deg = face
    angle = math.radians(angle_deg)
    at = [x - across * 0.14 * math.sin(angle), y + across * 0.14 * math.cos(angle), up * 0.14]
    size = [0.002, 0.34, 0.06] if lies else [0.002, 0.06, 0.28]
    return {"box": size, "at": [*(round(value, 6) for value in at), 0, 0, round(angle, 6)]}


def model_text(folder: str, table: dict) -> str:
    """The model.sdf of a table."""
    sdf = Element("sdf", version="1.6")
    add_model(sdf, table.get("name", folder), table)
    return document(sdf, SOURCE)


def add_model(parent: Element, name: str, table: dict) -> None:
    """Add the `<model>` of a table whose parts are plain shapes."""
    model = SubElement(parent, "model", name=name)
    if table.get("static"):
        _text(model, "static", "true")
    _add_pose(model, table.get("pose"))
    link = SubElement(model, "link", name=table.get("link", "link"))
    _add_pose(link, table.get("link_pose"))
    if not table.get("static"):
        _add_inertial(link, table)
    for number, part in enumerate(table["parts"], 1):
        for kind, wanted in (("collision", "solid"), ("visual", "seen")):
            if part.get(wanted, True):
                _add_shape(link, kind, f"{kind}_{number}", part)


def document(root: Element, source: str) -> str:
    """The text of a file; `source` is the script and input that wrote it."""
    indent(root, " ")
    text = tostring(root, encoding="unicode")
    return f'<?xml version="1.0"?>\n<!-- Written by {source}. -->\n{text}\n'


def config_text(folder: str, table: dict) -> str:
    """The model.config of a table."""
    model = Element("model")
    _text(model, "name", table.get("name", folder))
    _text(model, "version", "1.0")
    _text(model, "sdf", "model.sdf").set("version", "1.6")
    if "description" in table:
        _text(model, "description", table["description"])
    return document(model, SOURCE)


def _add_shape(link: Element, kind: str, name: str, part: dict) -> None:
    element = SubElement(link, kind, name=name)
    at = part.get("at", [])
    _add_pose(element, at if any(at) else None)
    geometry = SubElement(element, "geometry")
    match _shape(part):
        case "box", size:
            _text(SubElement(geometry, "box"), "size", _numbers(size))
        case "cylinder", (radius, length):
            cylinder = SubElement(geometry, "cylinder")
            _text(cylinder, "radius", _numbers([radius]))
            _text(cylinder, "length", _numbers([length]))
        case "sphere", radius:
            _text(SubElement(geometry, "sphere"), "radius", _numbers([radius]))
    if kind == "visual":
        _add_material(SubElement(element, "material"), part["look"])


def _add_material(material: Element, look: str | list[float]) -> None:
    if isinstance(look, str):
        script = SubElement(material, "script")
        _text(script, "uri", "file://media/materials/scripts/gazebo.material")
        _text(script, "name", look)
        return
    for tag in ("ambient", "diffuse"):
        _text(material, tag, _numbers([*look, 1]))


def _add_inertial(link: Element, table: dict) -> None:
    """Of the solid parts, with one density; the angles of parts are ignored."""
    solid = [part for part in table["parts"] if part.get("solid", True)]
    volumes = [_volume(part) for part in solid]
    mass = table.get("mass", 1)
    masses = [mass * volume / sum(volumes) for volume in volumes]
    places = [part.get("at", [0, 0, 0])[:3] for part in solid]
    centre = [sum(m * place[i] for m, place in zip(masses, places, strict=True)) / mass
              for i in range(3)]
    moments = [0.0, 0.0, 0.0]
    for m, part, place in zip(masses, solid, places, strict=True):
        squares = [(place[i] - centre[i]) ** 2 + side ** 2 / 12
                   for i, side in enumerate(_sides(part))]
        for i in range(3):
            moments[i] += m * (sum(squares) - squares[i])
    inertial = SubElement(link, "inertial")
    _add_pose(inertial, centre if any(abs(value) > 1e-9 for value in centre) else None)
    _text(inertial, "mass", _numbers([mass]))
    inertia = SubElement(inertial, "inertia")
    for tag, value in zip(("ixx", "iyy", "izz"), moments, strict=True):
        _text(inertia, tag, f"{value:.6g}")
    for tag in ("ixy", "ixz", "iyz"):
        _text(inertia, tag, "0")


def _shape(part: dict) -> tuple:
    kind = next(kind for kind in SHAPES if kind in part)
    return kind, part[kind]


def _volume(part: dict) -> float:
    match _shape(part):
        case "box", size:
            return math.prod(size)
        case "cylinder", (radius, length):
            return math.pi * radius ** 2 * length
        case "sphere", radius:
            return 4 / 3 * math.pi * radius ** 3
    raise ValueError(part)


def _sides(part: dict) -> list[float]:
    """Sides, m, of a box with the same moments of inertia per mass."""
    match _shape(part):
        case "box", size:
            return size
        case "cylinder", (radius, length):
            return [math.sqrt(3) * radius, math.sqrt(3) * radius, length]
        case "sphere", radius:
            return [math.sqrt(12 / 5) * radius] * 3
    raise ValueError(part)


def _add_pose(parent: Element, pose: list[float] | None) -> None:
    if pose is not None:
        _text(parent, "pose", _numbers([*pose, 0, 0, 0][:6]))


def _text(parent: Element, tag: str, text: str) -> Element:
    element = SubElement(parent, tag)
    element.text = text
    return element


def _numbers(values: list[float]) -> str:
    return " ".join(f"{value:.7g}" for value in values)


def files(props: Path = DATA / "props") -> dict[str, str]:
    """Text by path below data/models of all files that belong there."""
    written = {}
    for folder, table in read_props(props).items():
        by_hand = table.get("by_hand")
        written[f"{folder}/model.sdf"] = (
            (props / by_hand).read_text(encoding="utf-8") if by_hand else model_text(folder, table))
        written[f"{folder}/model.config"] = config_text(folder, table)
    return written


def write_models(models: Path = DATA / "models", props: Path = DATA / "props") -> None:
    """Make the folder `models` hold what `props` describes, and no other model."""
    wanted = files(props)
    for name, text in wanted.items():
        replace_file(models / name, text.encode())
    folders = {name.partition("/")[0] for name in wanted}
    for folder in models.iterdir():
        if folder.name not in folders:
            shutil.rmtree(folder)


def replace_file(path: Path, data: bytes) -> bool:
    """Make it hold the data; False if it did already. OSError if it cannot.

    A file that is right is left alone, and one that is not is replaced at once: simulators that
    run may be reading it.
    """
    if path.is_file() and path.read_bytes() == data:
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f"{path.name}.{uuid.uuid4().hex}")  # containers share process ids
    new.write_bytes(data)
    new.replace(path)
    return True


if __name__ == "__main__":
    write_models()
