"""Writes the log of a run (`bullet_sim.formats.run_log`), from which it can be repeated.

Everything is noted in the loop's thread when it takes effect, so the log is exact.
"""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path
from typing import Any, BinaryIO

import rospy
from rosgraph_msgs.msg import Log

from bullet_sim.fingerprint import description_hash, fingerprint
from bullet_sim.formats.run_log import header, part
from bullet_sim_ros import names
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.services.answers import HARMLESS
from bullet_sim_ros.simulation import Simulation

PART = 1.0  # s, simulated: what a run that is killed may lack of its end
MARK = "mark "  # how the lines begin by which a learner's program marks a moment
UPRIGHT = 0.7  # z of a contact's normal, from which on one stands on the other
# What reads only; of plugins' services, all of which are announced.
READS = ("get_", "list_")


def request_hash(source: Input) -> str:
    """SHA-256 of a request or message."""
    return sha256(source.serialized()).hexdigest()


class RunLog:
    """Writes from the beginning of the simulation to its end."""

    def __init__(self, simulation: Simulation, path: Path):
        """OSError if the file cannot be written."""
        self._simulation, self._world = simulation, simulation.world
        self._file: BinaryIO | None = path.open("wb", buffering=0)
        self._begin = self._tick = self._written = self._world.tick
        self._harmless = {rospy.resolve_name(name) for name in HARMLESS}
        self._takers: dict[tuple[str, int], int] = {}
        self._fingerprint = b""
        self._touching: set[tuple[str, str]] = set()
        self._lines: list[Any] = [header(
            world=rospy.get_param(names.RUNNING, {}).get("world", ""),
            world_sha256=description_hash(self._world.description), seed=self._world.seed,
            timestep=self._world.timestep, tick=self._begin,
            run=json.loads(rospy.get_param(names.RUN_LOG_OF, "{}")))]
        self._write()
        simulation.mailbox.each_input.append(self._note_input)
        simulation.mailbox.each_call.append(self._note_call)
        simulation.lockstep.each_question.append(self._note_image)
        rospy.Subscriber("/rosout", Log, self._take_line)
        simulation.at_close.append(self._end)

    # --- in the loop

    def _note_image(self) -> None:
        """An image is to be answered now."""
        self._fingerprint = fingerprint(self._world, self._fingerprint)
        self._lines.append(["i", self._passed(), self._fingerprint.hex()])
        self._mark_contacts()
        if (self._tick - self._written) * self._world.timestep >= PART:
            self._written = self._tick
            self._write()

    def _note_input(self, source: Input) -> None:
        if source.called and self._world.tick == self._begin and source.message is not None:
            self._lines.append(["setup", source.name, request_hash(source)])
        elif source.number is not None:
            key = source.name, source.number
            if key not in self._takers:
                self._takers[key] = len(self._takers)
                self._lines.append(["to", *key])
            self._note_time()
            self._lines.append([self._takers[key], source.serialized().hex()])
        else:
            self._note_lack(source.name)

    def _note_call(self, name: str, _caller: str) -> None:
        """Called for every service; those of plugins act in threads of their own."""
        reads = name in self._harmless or name.rpartition("/")[2].startswith(READS)
        if not reads and not self._simulation.inputs.has(name):
            self._note_lack(name)

    def _note_lack(self, name: str) -> None:
        if self._world.tick > self._begin:
            self._note_time()
            self._lines.append(["lacks", name])

    def _note_time(self) -> None:
        if passed := self._passed():
            self._lines.append(["t", passed])

    def _passed(self) -> int:
        """Steps since this was last asked for."""
        before, self._tick = self._tick, self._world.tick
        return self._tick - before

    def _mark_contacts(self) -> None:
        """Mark each pair of models that begin to touch from the side: not what stands on what."""
        found = set()
        for contact in self._world.contacts():
            pair = tuple(sorted(link.partition("::")[0] for link in contact.links))
            if abs(contact.normal[2]) < UPRIGHT and pair[0] != pair[1]:
                found.add(pair)
        for pair in sorted(found - self._touching):
            self._mark("contact", " ".join(pair))
        self._touching = found

    def _mark(self, name: str, text: str = "") -> None:
        self._lines.append(["mark", name, round(self._world.time, 9), text])

    def _end(self) -> None:
        self._lines.append(["end"])
        self._write()
        self._close()

    def _write(self) -> None:
        """Append what is new; if that fails, the simulation goes on without a log."""
        if self._file is None:
            return
        data, self._lines = part(self._lines), []
        try:
            while data:
                data = data[self._file.write(data):]
        except OSError as error:
            rospy.logwarn("parameter %s: %s: %s; the run cannot be gone back to",
                          rospy.resolve_name(names.RUN_LOG), self._file.name, error.strerror)
            self._close()

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    # --- in a ROS thread

    def _take_line(self, line: Log) -> None:
        if line.msg.startswith(MARK):
            name = " ".join(line.msg.removeprefix(MARK).split())
            self._simulation.mailbox.post(lambda: self._mark(name, line.name))
