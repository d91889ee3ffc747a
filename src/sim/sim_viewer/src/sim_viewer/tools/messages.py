"""Messages as short YAML text, as a form to fill in, and their numbers by path.

A path is spelt as in rqt_plot: `/odom/pose/pose/position/x`. An element of an array is
`/scan/ranges[10]` or `/scan/ranges/10`; `/turtle1/pose/x:y` is two paths, and a path that ends at
a message is all numbers directly in it.
"""

import re
from collections.abc import Iterable
from typing import Any

import genpy
import genpy.message
import numpy as np
import yaml
from node_basics.bounded_yaml import PlainLoader
from roslib.message import get_message_class

from sim_viewer.registry import Refused

NUMBERS = frozenset(["int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64",
                     "byte", "char", "float32", "float64", "bool"])
TIMES = frozenset(["time", "duration"])  # read as seconds
MOST_PATHS = 400  # offered for one type
MOST_LISTED = 9  # elements of an array of known length; of longer ones only the first is listed
ELEMENT = re.compile(r"^([A-Za-z]\w*)((?:\[\d{1,9}\])*)$")

Step = str | int
MOST_ELEMENTS = 24  # of an array, before it is cut
MOST_LETTERS = 2_000  # of a string
MOST_TEXT = 40_000  # letters of a message
LONGEST = 20_000  # letters of a filled-in form
DEFAULTS = {"string": '""', "bool": "false", "time": "{secs: 0, nsecs: 0}",
            "duration": "{secs: 0, nsecs: 0}", "float32": "0.0", "float64": "0.0"}
BOUNDS = {f"{sign}int{bits}": (0 if sign else -(1 << bits - 1), (1 << bits - (not sign)) - 1)
          for sign in ("", "u") for bits in (8, 16, 32, 64)}


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


def to_text(message: Any, most_elements: int = MOST_ELEMENTS) -> str:
    """The fields of a message, as `rostopic echo` shows them but with long arrays cut."""
    text = "\n".join(_lines(message, most_elements)) or "{}"
    if len(text) > MOST_TEXT:
        return text[:MOST_TEXT] + f"\n... {len(text) - MOST_TEXT} more letters"
    return text


def _lines(message: Any, most: int) -> list[str]:
    lines = []
    for name in message.__slots__:
        value = getattr(message, name)
        if isinstance(value, genpy.Message):
            inner = _lines(value, most)
            lines += [f"{name}:", *("  " + line for line in inner)] if inner else [f"{name}: {{}}"]
        elif _is_message_list(value):
            lines += [f"{name}:", *_list_lines(value, most)]
        else:
            lines.append(f"{name}: {_inline(value, most)}")
    return lines


def _list_lines(values: Any, most: int) -> list[str]:
    lines = []
    for value in values[:most]:
        inner = _lines(value, most) or ["{}"]
        lines += [f"  - {inner[0]}", *("    " + line for line in inner[1:])]
    if len(values) > most:
        lines.append(f"  # ... {len(values)} in all")
    return lines


def _inline(value: Any, most: int) -> str:
    if isinstance(value, genpy.TVal):
        return f"{{secs: {value.secs}, nsecs: {value.nsecs}}}"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, np.ndarray):
        return _cut_list(value[:most].tolist(), len(value), most)
    if isinstance(value, (bytes, bytearray, list, tuple)):
        return _cut_list(list(value[:most]), len(value), most)
    return str(value)


def _cut_list(first: list, count: int, most: int) -> str:
    shown = ", ".join(_inline(one, most) for one in first)
    return f"[{shown}]" + (f"  # ... {count} in all" if count > most else "")


def _quoted(text: str) -> str:
    """A YAML string; control characters are escaped."""
    cut = text[:MOST_LETTERS]
    safe = cut.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
    safe = "".join(c if c.isprintable() else f"\\u{ord(c) & 0xFFFF:04x}" for c in safe)
    return f'"{safe}"' + (f"  # ... {len(text)} letters" if len(text) > MOST_LETTERS else "")


def _is_message_list(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and isinstance(value[0], genpy.Message)


def load_yaml(text: str) -> Any:
    """The value of a YAML text; Refused with the line of the error."""
    if len(text) > LONGEST:
        raise Refused(f"{len(text)} letters are too many; at most {LONGEST}")
    try:
        return yaml.load(text, PlainLoader)
    except yaml.MarkedYAMLError as error:
        line = f"line {error.problem_mark.line + 1}: " if error.problem_mark else ""
        raise Refused(f"not YAML: {line}{error.problem}") from None
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise Refused(f"not YAML: {' '.join(str(error).split())[:200]}") from None


def template(message_class: type) -> str:
    """YAML with every field at its default, and its type as a comment."""
    return "\n".join(_template_lines(message_class)) or "{}  # nothing to fill in"


def _template_lines(message_class: type) -> list[str]:
    lines = []
    for name, kind in slots(message_class).items():
        inner = class_of(kind)
        if kind.endswith("]"):
            lines.append(f"{name}: []  # {kind}")
        elif inner and not _is_flat(inner):
            lines += [f"{name}:", *("  " + line for line in _template_lines(inner))]
        elif inner:
            fields = ", ".join(f"{slot}: {DEFAULTS.get(of, '0')}"
                               for slot, of in slots(inner).items())
            lines.append(f"{name}: {{{fields}}}")
        else:
            lines.append(f"{name}: {DEFAULTS.get(kind, '0')}  # {kind}")
    return lines


def _is_flat(message_class: type) -> bool:
    """Whether it fits on one line: a few plain values, as in a point or a quaternion."""
    kinds = message_class._slot_types
    return len(kinds) <= 4 and all(kind in BOUNDS or kind in DEFAULTS for kind in kinds)


def fill(message_class: type, text: str) -> Any:
    """A message from a filled-in template; Refused in one line that names the field."""
    values = load_yaml(text)
    if values is None:
        values = {}
    if not isinstance(values, dict):
        raise Refused(f"the request is a list of `field: value`; {_fields(message_class)}")
    message = message_class()
    _check(message_class, values, "")
    try:
        genpy.message.fill_message_args(message, [values])
        message._check_types()
    except (genpy.MessageException, TypeError, ValueError, AttributeError) as error:
        raise Refused(f"{' '.join(str(error).split())}; {_fields(message_class)}") from None
    return message


def _check(message_class: type, values: dict, path: str) -> None:
    """Checks that genpy leaves to serialisation or reports unclearly: fields, types, bounds."""
    kinds = slots(message_class)
    for name, value in values.items():
        if name not in kinds:
            raise Refused(f"there is no field {f'{path}{name}'!r:.80}; {_fields(message_class)}")
        _check_value(kinds[name], value, f"{path}{name}")


def _check_value(kind: str, value: Any, path: str) -> None:
    if kind.endswith("]"):
        element, _, count = kind[:-1].rpartition("[")
        if not isinstance(value, list):
            raise Refused(f"{path} is {value!r:.40}; {kind} is a list: [ ... ]")
        if count and len(value) != int(count):
            raise Refused(f"{path} has {len(value)} elements; {kind} has {count}")
        for index, one in enumerate(value):
            _check_value(element, one, f"{path}[{index}]")
    elif "/" in kind:
        inner = get_message_class(kind)
        if not isinstance(value, dict) or inner is None:
            raise Refused(f"{path} is {value!r:.40}; {kind} is {{field: value, ...}}")
        _check(inner, value, path + ".")
    elif not _fits(kind, value):
        raise Refused(f"{path} is {value!r:.40}, which is not of type {kind}")


def _fits(kind: str, value: Any) -> bool:
    if kind in ("string", "bool"):
        return isinstance(value, str if kind == "string" else bool)
    if kind in ("time", "duration"):
        return isinstance(value, dict) and set(value) <= {"secs", "nsecs"} and all(
            _fits("int32" if kind == "duration" else "uint32", part) for part in value.values())
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    if kind in BOUNDS:
        low, high = BOUNDS[kind]
        return isinstance(value, int) and low <= value <= high
    return True


def _fields(message_class: type) -> str:
    names = ", ".join(message_class.__slots__)
    return f"{message_class._type} has: {names or 'no fields'}"
