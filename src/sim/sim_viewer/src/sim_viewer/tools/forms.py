"""Requests of services as YAML text: a template to fill in, and its conversion to a message."""

from typing import Any

import genpy
import genpy.message
import yaml
from roslib.message import get_message_class

from sim_viewer.registry import Refused
from sim_viewer.tools.fields import class_of, slots

LONGEST = 20_000  # letters of a filled-in form
DEFAULTS = {"string": '""', "bool": "false", "time": "{secs: 0, nsecs: 0}",
            "duration": "{secs: 0, nsecs: 0}", "float32": "0.0", "float64": "0.0"}
BOUNDS = {f"{sign}int{bits}": (0 if sign else -(1 << bits - 1), (1 << bits - (not sign)) - 1)
          for sign in ("", "u") for bits in (8, 16, 32, 64)}


class PlainLoader(yaml.SafeLoader):
    """YAML without anchors and aliases, by which a short text can expand to a huge one."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """As SafeLoader's; YAMLError for anchors and aliases."""
        event = self.peek_event()
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise yaml.YAMLError("anchors (&) and aliases (*) are not allowed here")
        return super().compose_node(parent, index)


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
