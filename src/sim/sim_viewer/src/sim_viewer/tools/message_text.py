"""Messages as YAML text, short enough to read: long arrays and strings are cut, with a mark."""

from typing import Any

import genpy
import numpy as np

MOST_ELEMENTS = 24  # of an array, before it is cut
MOST_LETTERS = 2_000  # of a string
MOST_TEXT = 40_000  # letters of a message


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
