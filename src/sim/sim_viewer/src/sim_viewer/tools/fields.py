"""Paths to numbers in messages, as rqt_plot spells them: `/odom/pose/pose/position/x`.

An element of an array is `/scan/ranges[10]` or `/scan/ranges/10`; `/turtle1/pose/x:y` is two paths,
and a path that ends at a message is all numbers directly in it.
"""

import re
from collections.abc import Iterable

import genpy
from roslib.message import get_message_class

from sim_viewer.registry import Refused

NUMBERS = frozenset(["int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64",
                     "byte", "char", "float32", "float64", "bool"])
TIMES = frozenset(["time", "duration"])  # read as seconds
MOST_PATHS = 400  # offered for one type
MOST_LISTED = 9  # elements of an array of known length; of longer ones only the first is listed
ELEMENT = re.compile(r"^([A-Za-z]\w*)((?:\[\d{1,9}\])*)$")

Step = str | int


def split_topic(path: str, topics: Iterable[str]) -> tuple[str, str]:
    """The longest of `topics` that `path` begins with, and the rest without its slash; Refused if
    there is none."""
    fitting = [t for t in topics if path == t or path.startswith((t + "/", t + "["))]
    if not fitting:
        raise Refused(f"{path}: no such topic. The Topics tab lists what there is")
    topic = max(fitting, key=len)
    return topic, path[len(topic):].lstrip("/")


def parse_steps(path: str) -> list[Step]:
    """`pose/position/x` and `ranges[10]` as the names and indices that lead there; else Refused."""
    steps: list[Step] = []
    for part in [part for part in path.split("/") if part]:
        if part.isascii() and part.isdigit() and len(part) < 10:
            steps.append(int(part))
            continue
        match = ELEMENT.match(part)
        if not match:
            raise Refused(f"{path}: '{part}' is not a field; "
                          "write /topic/field/0 or /topic/field[0]")
        steps.append(match[1])
        steps.extend(int(index) for index in re.findall(r"\d+", match[2]))
    return steps


def expand(path: str, message_class: type) -> list[str]:
    """The paths to single numbers that `path` (below the topic) names; else Refused."""
    parent, _, last = path.rpartition("/")
    names = last.split(":") if ":" in last else [last]
    found = []
    for name in names:
        single = f"{parent}/{name}" if parent else name
        kind = field_type(message_class, parse_steps(single))
        if is_number(kind):
            found.append(single)
            continue
        numbers = [f"{single}/{slot}".lstrip("/") for slot, of in slots(class_of(kind)).items()
                   if is_number(of)]
        if not numbers:
            raise Refused(f"{kind} is not a number; it has: {_choices(kind)}")
        found.extend(numbers)
    return found


def field_type(message_class: type, steps: list[Step]) -> str:
    """ROS's name for the type at the end of `steps`, such as `float64` or `float32[]`; Refused if
    a step does not exist."""
    kind = message_class._type
    for step in steps:
        if isinstance(step, int):
            if not kind.endswith("]"):
                raise Refused(f"{kind} has no elements, so [{step}] does not fit")
            kind = kind[:kind.rindex("[")]
            continue
        known = slots(class_of(kind))
        if step not in known:
            raise Refused(f"{kind} has no field '{step}'; it has: {_choices(kind)}")
        kind = known[step]
    return kind


def is_number(kind: str) -> bool:
    return kind in NUMBERS or kind in TIMES


def value(message: object, steps: list[Step]) -> float | None:
    """The number at the end of `steps`; None if the index is beyond the end of an array."""
    try:
        for step in steps:
            message = message[step] if isinstance(step, int) else getattr(message, step)
    except IndexError:
        return None
    return message.to_sec() if isinstance(message, genpy.TVal) else float(message)


def numeric_paths(message_class: type) -> list[str]:
    """Paths to the numbers of a type in the order of its file, for a list to choose from."""
    found: list[str] = []
    _collect(message_class._type, "", found)
    return found[:MOST_PATHS]


def _collect(kind: str, path: str, found: list[str]) -> None:
    if len(found) >= MOST_PATHS:
        return
    if is_number(kind):
        found.append(path)
    elif kind.endswith("]"):
        element, _, count = kind[:-1].rpartition("[")
        listed = int(count) if count and int(count) <= MOST_LISTED else 1
        for index in range(listed):
            _collect(element, f"{path}[{index}]", found)
    else:
        for slot, of in slots(class_of(kind)).items():
            _collect(of, f"{path}/{slot}".lstrip("/"), found)


def class_of(kind: str) -> type | None:
    """The class of a field's type; None if it is not a message, or not built here."""
    return get_message_class(kind) if "/" in kind and not kind.endswith("]") else None


def slots(message_class: type | None) -> dict[str, str]:
    """Names and types of a message's fields; empty for None."""
    return dict(zip(message_class.__slots__, message_class._slot_types)) if message_class else {}


def _choices(kind: str) -> str:
    if kind.endswith("]"):
        return "an index as [0]"
    return ", ".join(slots(class_of(kind))) or "no fields"
