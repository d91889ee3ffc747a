"""A .rviz file, as rviz writes it, read as plain data for the page. Without ROS."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from node_basics.bounded_yaml import PlainLoader

from sim_viewer.rviz.options import Option, defaults, rgb
from sim_viewer.rviz.types import TYPES

GROUP = "rviz/Group"
BACKGROUND = "48; 48; 48"
MOST_DISPLAYS = 50
LARGEST_FILE = 1 << 20  # bytes
TOOL_TOPICS = {  # by rviz's class: the page's name and rviz's topic
    "rviz/SetInitialPose": ("initial_pose", "/initialpose"),
    "rviz/SetGoal": ("goal", "/move_base_simple/goal"),
    "rviz/PublishPoint": ("point", "/clicked_point"),
}
TOPICS = dict(TOOL_TOPICS.values())
BEGINNING = ("rviz/Grid", "rviz/RobotModel", "rviz/Map", "rviz/LaserScan")  # shown without a file


class ConfigError(ValueError):
    """A file that cannot be used; the text names it, the line and what is wrong."""


def read_config(path: str | Path) -> dict[str, Any]:
    """What `parse` gives for a file; ConfigError if it cannot be read."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}; give a .rviz file") from None
    if len(data) > LARGEST_FILE:
        raise ConfigError(f"{path} is larger than {LARGEST_FILE} bytes: no .rviz file")
    try:
        read = PlainLoader(data.decode("utf-8")).get_single_data()
    except UnicodeDecodeError:
        raise ConfigError(f"{path} is not text; give a .rviz file") from None
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise ConfigError(f"{path}{_where(error)}: this is not valid YAML: {_what(error)}") \
            from None
    try:
        return parse(read)
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}") from None


def parse(read: Any) -> dict[str, Any]:
    """`fixed_frame`, `background`, `displays`, `topics` of tools, and `view` of a file's content.

    A display is {class, name, enabled, topic, options, warnings, supported}; those in groups are
    listed among the others. ConfigError if the content is not a configuration of rviz.
    """
    if not isinstance(read, Mapping) or not isinstance(read.get("Visualization Manager"), Mapping):
        raise ConfigError("there is no `Visualization Manager:`, which rviz writes in each .rviz "
                          "file")
    manager = read["Visualization Manager"]
    displays = _displays(manager.get("Displays"), "Displays", True)
    if len(displays) > MOST_DISPLAYS:
        raise ConfigError(f"{len(displays)} displays are more than the {MOST_DISPLAYS} of a page")
    look = _mapping(manager.get("Global Options"), "Global Options")
    background = str(look.get("Background Color", BACKGROUND))
    return {"fixed_frame": str(look.get("Fixed Frame", "map")),
            "background": background if rgb(background) else BACKGROUND,
            "displays": displays, "topics": _topics(manager.get("Tools")),
            "view": _view(manager.get("Views"))}


def beginning() -> dict[str, Any]:
    """The configuration without a file; the empty fixed frame stands for any that exists, and so do
    the topics of its displays (`topic_is_default`)."""
    return {"fixed_frame": "", "background": BACKGROUND, "topics": TOPICS, "view": {},
            "displays": [_display({"Class": name, "Enabled": True}, True)
                         | {"topic_is_default": True} for name in BEGINNING]}


def _displays(listed: Any, where: str, enabled: bool) -> list[dict[str, Any]]:
    if listed is None:
        return []
    if not isinstance(listed, list):
        raise ConfigError(f"{where} is not a list")
    found = []
    for number, entry in enumerate(listed, 1):
        if not isinstance(entry, Mapping) or not isinstance(entry.get("Class"), str):
            raise ConfigError(f"{where}: entry {number} has no Class, such as rviz/LaserScan")
        if entry["Class"] == GROUP:
            name = f"{where}: {entry.get('Name', GROUP)}"
            found += _displays(entry.get("Displays"), name,
                               enabled and entry.get("Enabled") is not False)
        else:
            found.append(_display(entry, enabled))
    return found


def _display(entry: Mapping[str, Any], enabled: bool) -> dict[str, Any]:
    name = entry["Class"]
    kind = TYPES.get(name)
    shown = {"class": name, "name": str(entry.get("Name", name.rpartition("/")[2])),
             "enabled": enabled and bool(entry.get("Enabled", True)), "topic": "", "options": {},
             "warnings": [], "supported": kind is not None}
    if kind is None:
        return shown
    if kind.messages:
        shown["topic"] = str(entry.get(kind.topic_key) or entry.get("Topic") or kind.topic)
    given = flat(entry)
    shown["options"] = defaults(kind.options)
    for option in kind.options:
        value = entry.get(option.name) if option.kind == "namespaces" else _find(given, option)
        if value is not None:
            try:
                shown["options"][option.name] = option.check(value)
            except ValueError as error:
                shown["warnings"].append(str(error))
    return shown


def flat(entry: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Nested properties as `Shape/Color`; a property's own value has the plain name as its key."""
    found: dict[str, Any] = {}
    for name, value in entry.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{before}{name}/")
        elif name == "Value" and before:
            found[before[:-1]] = found[f"{before}Value"] = value
        else:
            found[f"{before}{name}"] = value
    return found


def _find(given: dict[str, Any], option: Option) -> Any:
    value = given.get(option.name, given.get(f"Shape/{option.name}"))
    if option.kind == "number" and isinstance(value, str):
        try:
            return float(value)  # YAML 1.1 reads 1e-05 as a text
        except ValueError:
            return value
    return value


def _topics(tools: Any) -> dict[str, str]:
    topics = dict(TOPICS)
    for tool in tools if isinstance(tools, list) else []:
        if isinstance(tool, Mapping) and tool.get("Class") in TOOL_TOPICS:
            name, usual = TOOL_TOPICS[tool["Class"]]
            topics[name] = str(tool.get("Topic") or usual)
    return topics


def _view(views: Any) -> dict[str, Any]:
    """The camera: `class`, `frame`, `focus` (the focal point) and numbers."""
    current = _mapping(_mapping(views, "Views").get("Current"), "Views: Current")
    named = {"distance": "Distance", "pitch": "Pitch", "yaw": "Yaw", "x": "X", "y": "Y",
             "scale": "Scale", "angle": "Angle"}
    given = flat(current)
    focus = [given.get(f"Focal Point/{axis}", 0.0) for axis in "XYZ"]
    return {"class": str(current.get("Class", "")), "frame": str(current.get("Target Frame", "")),
            "focus": focus if all(map(_is_number, focus)) else [0.0, 0.0, 0.0],
            **{name: given[key] for name, key in named.items() if _is_number(given.get(key))}}


def _is_number(value: Any) -> bool:
    return (isinstance(value, (int, float)) and not isinstance(value, bool)
            and math.isfinite(value))


def _mapping(value: Any, where: str) -> Mapping[str, Any]:
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ConfigError(f"{where} is not a mapping")
    return value


def _where(error: Exception) -> str:
    mark = getattr(error, "problem_mark", None)
    return f", line {mark.line + 1}" if mark else ""


def _what(error: Exception) -> str:
    return " ".join(str(getattr(error, "problem", None) or error).split())
