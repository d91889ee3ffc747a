"""Events of Linux' joystick interface (linux/joystick.h) as axes and buttons."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field

EVENT = struct.Struct("<IhBB")  # time in ms, value, type, number
BUTTON, AXIS, INITIAL = 0x01, 0x02, 0x80  # types; INITIAL: the state when the device was opened
FULL = 32767  # an axis at its end


@dataclass
class Stick:
    """The state of a joystick.

    Axes go from -1 to 1, left and up are positive, and within `deadzone` (0 to 0.9) they are 0.
    `default_trig_val`: axes that stand off centre at the start (triggers, at 1) are reported as
    they are, else as 0 until they are touched. `sticky_buttons`: a press changes over, a release
    does nothing.
    """

    deadzone: float = 0.05
    default_trig_val: bool = False
    sticky_buttons: bool = False
    axes: list[float] = field(default_factory=list)
    buttons: list[int] = field(default_factory=list)

    def take(self, value: int, kind: int, number: int) -> bool:
        """Enter one event; True if it is a button's, which is published at once."""
        if kind & ~INITIAL == AXIS:
            untouched = kind & INITIAL and not self.default_trig_val
            _put(self.axes, number, 0.0 if untouched else self._axis(value))
            return False
        if kind & ~INITIAL != BUTTON:
            return False
        if not self.sticky_buttons or kind & INITIAL:
            _put(self.buttons, number, int(bool(value)))
        elif value:
            before = self.buttons[number] if number < len(self.buttons) else 0
            _put(self.buttons, number, 1 - before)
        else:
            _put(self.buttons, number, self.buttons[number] if number < len(self.buttons) else 0)
        return True

    def _axis(self, value: int) -> float:
        dead = FULL * self.deadzone
        beyond = max(0.0, abs(value) - dead) / (FULL - dead)
        return min(1.0, beyond) * (-1.0 if value > 0 else 1.0) if beyond else 0.0


def _put(values: list, number: int, value: float) -> None:
    values.extend([type(value)(0)] * (number + 1 - len(values)))
    values[number] = value


def events_in(data: bytes) -> Iterator[tuple[int, int, int]]:
    """(value, type, number) of each whole event."""
    whole = len(data) - len(data) % EVENT.size
    for _, value, kind, number in EVENT.iter_unpack(data[:whole]):
        yield value, kind, number


def usable_deadzone(deadzone: float) -> float:
    """Between 0 and 0.9; from 1 on it is counted in an old unit, 1/32767."""
    return min(0.9, max(0.0, deadzone / FULL if deadzone >= 1.0 else deadzone))
