"""A log of true states and calls, as lines of JSON in a file that only this process writes.

Its purpose is that of Gazebo's state log (`gzserver --record`): to examine a run without trusting
any node. A line is one of
    {"time": s, "poses": {MODEL: [x, y, z, qx, qy, qz, qw]}, "contacts": [[MODEL, MODEL], ...],
     "unanswered": N}
    {"call": SERVICE or TOPIC, "caller": NODE}
    {"shutdown": REASON}
Poses are those of models that can move, in the world frame, m; a contact is a pair of models; N is
the number of camera frames so far that had no answer in lockstep.
"""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import TextIO

import rospy

from bullet_sim.world import World
from bullet_sim_ros import names
from bullet_sim_ros.simulation import Simulation

RATE_HZ = 25.0  # of simulated time


class StateLog:
    """Writes from the beginning of the simulation to its end."""

    def __init__(self, simulation: Simulation, path: Path):
        """OSError if the file cannot be written."""
        self._world, self._lockstep = simulation.world, simulation.lockstep
        self._stop = simulation.stop
        self._file: TextIO = path.open("w", encoding="utf-8", buffering=1)
        simulation.mailbox.each_call.append(
            lambda name, caller: self._write({"call": name, "caller": caller}))
        simulation.scheduler.add(RATE_HZ, self._write_state)
        rospy.core.add_preshutdown_hook(lambda reason: self._write({"shutdown": reason}))

    def _write_state(self) -> None:
        self._write({"time": round(self._world.time, 9), "poses": _poses(self._world),
                     "contacts": _touching(self._world),
                     "unanswered": self._lockstep.unanswered})

    def _write(self, values: dict) -> None:
        """A log with a gap would be misleading, so if it cannot be written, the simulation ends."""
        if self._file.closed:
            return
        try:
            self._file.write(json.dumps(values) + "\n")
        except OSError as error:
            rospy.logfatal("state log %s: %s: the simulation ends; make room there, or name another"
                           " file by %s", self._file.name, error.strerror,
                           rospy.resolve_name(names.STATE_LOG))
            with contextlib.suppress(OSError):  # from flushing the rest
                self._file.close()
            self._stop()


def _poses(world: World) -> dict[str, list[float]]:
    return {model.name: [*model.pose.position, *model.pose.orientation]
            for model in world.models.values() if not model.static}


def _touching(world: World) -> list[tuple[str, str]]:
    pairs = {tuple(sorted((one.partition("::")[0], other.partition("::")[0])))
             for one, other in (contact.links for contact in world.contacts())}
    return sorted(pair for pair in pairs if pair[0] != pair[1])
