"""The log of a run in lockstep, from which the run can be repeated: how it is written and read.

It is a gzip file of JSON lines. Each part of it is a gzip member of its own, so it can be read up
to the last whole part when the writer was killed, and marks can be added afterwards, also behind a
part that was cut short. The first line is the header, a mapping; each other one is a list:
    ["setup", SERVICE, SHA-256]  a call before time began, with the hash of its request
    ["to", NAME, N]              from here on number 0, 1, ... stands for the N-th taker of NAME
    ["t", STEPS]                 that many physics steps after the line before
    [NUMBER, HEX]                a message or request takes effect, serialised as by ROS 1
    ["i", STEPS, HEX]            so many steps later an image is to be answered; the fingerprint
    ["lacks", NAME]              something took effect that the log cannot repeat
    ["mark", NAME, S, TEXT]      something worth going back to, at a simulated time, s
    ["end"]                      the run ended; without this line the log was cut short
"""

from __future__ import annotations

import gzip
import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from bullet_sim import __version__
from bullet_sim.errors import SimulationError

FORMAT = 1
SLACK = 1e-6  # s
PART = b"\x1f\x8b\x08\0\0\0\0\0"  # begins each part: gzip, without a name or time
MARK = b'["mark",'  # begins a line of the part


class RunLogError(SimulationError):
    """A log that cannot be used, or has not what is asked for; one line."""


class PastEnd(RunLogError):
    """An image or a time after the last one."""


class Event(NamedTuple):
    """A line that the physics has to do with, at its step."""

    tick: int
    kind: str  # "image", "input" or "lacks"
    name: str = ""  # of the topic or service
    number: int = 0  # of an image, from 1; of the taker of an input
    data: bytes = b""  # the fingerprint; the message


class Mark(NamedTuple):
    """A moment worth going back to."""

    name: str
    time: float  # s, simulated
    text: str = ""


@dataclass
class RunLog:
    """What was read."""

    header: dict[str, Any]
    setup: list[tuple[str, str]] = field(default_factory=list)  # service, SHA-256 of its request
    events: list[Event] = field(default_factory=list)
    marks: list[Mark] = field(default_factory=list)
    whole: bool = False  # whether the run's end is in it

    @property
    def images(self) -> list[Event]:
        """The images, the first of which has the number 1."""
        return [event for event in self.events if event.kind == "image"]

    def time_of(self, event: Event) -> float:
        """Simulated time, s."""
        return event.tick * self.header["timestep"]

    def image_at(self, time: float) -> int:
        """Number of the last image up to this simulated time (s); at least 1."""
        return max(1, sum(self.time_of(image) <= time + SLACK for image in self.images))

    def find(self, at: str) -> int:
        """Number of an image: `image:700`, a simulated time in s, the end, or a mark (`lap:2`).

        RunLogError if there is none, with what there is; PastEnd if it would be after the end.
        """
        images = self.images
        if not images:
            raise RunLogError("the log has no image: the run ended before the first one")
        last, end = len(images), self.time_of(images[-1])
        word, _, number = at.partition(":")
        if word == "image":
            is_number = number.isascii() and number.isdecimal()
            if is_number and 1 <= int(number) <= last:
                return int(number)
            kind = PastEnd if is_number and int(number) > last else RunLogError
            raise kind(f"the log has no {at}; there are image:1 to image:{last}")
        if at == "end":
            return last
        try:
            time = float(at)
        except ValueError:
            return self._marked(word, number, at)
        if not 0 <= time <= end + SLACK:
            kind = PastEnd if time > end else RunLogError
            raise kind(f"the log has no image at {at} s; its last one is at {end:.3f} s")
        return self.image_at(time)

    def _marked(self, word: str, number: str, at: str) -> int:
        found = [mark for mark in self.marks if mark.name == at]
        which = 1
        if not found and (not number or (number.isascii() and number.isdecimal())):
            found, which = [mark for mark in self.marks if mark.name == word], int(number or 1)
        if not 1 <= which <= len(found):
            there = ", ".join(dict.fromkeys(mark.name for mark in self.marks))
            if not there:
                raise RunLogError(f"the log has no mark {at!r} nor any other: name a time in s, "
                                  "image:N or end")
            raise RunLogError(f"the log has no mark {at!r}; there are: {there}; or name a time in "
                              "s, image:N or end")
        return self.image_at(found[which - 1].time)


def header(**values: Any) -> dict[str, Any]:
    """A header with these values."""
    return {"run_log": FORMAT, "version": __version__, **values}


def part(lines: Sequence[Any]) -> bytes:
    """These lines as a part of the file."""
    text = "".join(json.dumps(line, separators=(",", ":"), ensure_ascii=False) + "\n"
                   for line in lines)
    return gzip.compress(text.encode(), 9, mtime=0)


def append_marks(path: Path, marks: Sequence[Mark]) -> None:
    """Add marks to a log that is written already; OSError if that fails."""
    if marks:
        with path.open("ab") as file:
            file.write(part([["mark", *mark] for mark in marks]))


def read_run_log(path: Path) -> RunLog:
    """The log, up to its last whole part; OSError, or RunLogError if it is none of this version."""
    lines = _lines(path.read_bytes())
    try:
        head = json.loads(lines[0])
        if not isinstance(head, dict) or "run_log" not in head:
            raise ValueError
    except (ValueError, IndexError):
        raise RunLogError(f"{path} is not the log of a run, or was cut short at once") from None
    if (head["run_log"], head.get("version")) != (FORMAT, __version__):
        raise RunLogError(f"{path} was written by version {head.get('version')}, this is "
                          f"{__version__}: only the same version repeats a run to the bit")
    log = RunLog(head)
    try:
        _fill(log, [json.loads(line) for line in lines[1:]])
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise RunLogError(f"{path} is damaged: {type(error).__name__}: {error}") from None
    return log


def _lines(data: bytes) -> list[bytes]:
    """The lines of all whole parts; behind one that was cut short, the marks alone."""
    found, begins = [], b""
    while data:
        member = zlib.decompressobj(wbits=31)  # 16 + 15: gzip
        try:
            text = member.decompress(data)
        except zlib.error:
            text = b""
        if member.eof:
            found += [line for line in text.splitlines() if line.startswith(begins)]
            data = member.unused_data
        else:
            begins, data = MARK, b"".join(data[1:].partition(PART)[1:])
    return found


def _fill(log: RunLog, lines: Sequence[list]) -> None:
    tick, images = log.header["tick"], 0
    takers: list[tuple[str, int]] = []
    for kind, *values in lines:
        if isinstance(kind, int):
            name, number = takers[kind]
            log.events.append(Event(tick, "input", name, number, bytes.fromhex(values[0])))
        elif kind == "i":
            tick, images = tick + values[0], images + 1
            log.events.append(Event(tick, "image", number=images, data=bytes.fromhex(values[1])))
        elif kind == "t":
            tick += values[0]
        elif kind == "to":
            takers.append((values[0], values[1]))
        elif kind == "setup":
            log.setup.append((values[0], values[1]))
        elif kind == "lacks":
            log.events.append(Event(tick, "lacks", values[0]))
        elif kind == "mark":
            log.marks.append(Mark(*values))
        elif kind == "end":
            log.whole = True
        else:
            raise ValueError(f"unknown line {kind!r}")
    log.marks.sort(key=lambda mark: mark.time)
