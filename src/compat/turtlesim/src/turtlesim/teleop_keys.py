"""What is typed in turtle_teleop_key's terminal, and what it means to the turtle."""

from __future__ import annotations

import re

TEXT = """Reading from keyboard
---------------------------
Use arrow keys to move the turtle. 'q' to quit."""
QUIT = "q"
ARROWS = {  # the last character of an arrow's escape sequence -> forward, turn to the left
    "A": (1.0, 0.0),
    "B": (-1.0, 0.0),
    "C": (0.0, -1.0),
    "D": (0.0, 1.0),
}
# One key: an escape sequence (of an arrow: ESC [ A, or ESC O A in some terminals) or a character.
_KEY = re.compile(
    r"\x1b[\[O][0-9;]*(?P<letter>[A-Za-z~])|(?P<begun>\x1b(?:[\[O][0-9;]*)?$)|.", re.DOTALL
)


def split_keys(typed: str) -> tuple[list[str], str]:
    """The keys, and what may be the beginning of one. An arrow is its A, B, C or D after ESC."""
    keys, rest = [], ""
    for found in _KEY.finditer(typed):
        if found["begun"]:
            rest = found["begun"]
        elif found["letter"]:
            keys.append("\x1b" + found["letter"])
        else:
            keys.append(found[0])
    return keys, rest


def drive(key: str) -> tuple[float, float] | None:
    """(forward, left) from -1 to 1, which the scales make m/s and rad/s; None for other keys."""
    return ARROWS.get(key[1:]) if key.startswith("\x1b") else None
