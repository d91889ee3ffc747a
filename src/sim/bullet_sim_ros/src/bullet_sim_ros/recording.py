"""A recording of what was to be seen, as lines of JSON in a file, from which a run is shown again.

A line is one of
    {"scene": SCENE}, a text of bullet_sim.rendering.scene_text; again when it has changed
    {"names": [MODEL::LINK, ...], "scripted": N} of the links that move, the last N of actors and
        static models, which physics does not move; again when they have changed
    {"time": s, "poses": [[x, y, z, qx, qy, qz, qw], ...]} in their order, in the world frame, m
A second simulation appends to the file of the first.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import TextIO

import rospy

from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.nested import NestedModel
from bullet_sim.pose import Pose
from bullet_sim.rendering.scene_text import scene_to_text
from bullet_sim_ros import names
from bullet_sim_ros.simulation import Simulation

RATE_HZ = 10.0  # of simulated time
DIGITS = 5


class Recording:
    """Writes from the beginning of the simulation to its end."""

    def __init__(self, simulation: Simulation, path: Path):
        """OSError if the file cannot be written."""
        self._world = simulation.world
        self._version: int | None = None  # of the scene that was written
        self._names: list[str] = []
        self._placed: dict[str, Pose] = {}  # static models, where they were first seen
        self._moved: set[str] = set()  # those that are or were elsewhere
        self._file: TextIO | None = path.open("a", encoding="utf-8", buffering=1)
        simulation.scheduler.add(RATE_HZ, self._write_state)

    def _write_state(self) -> None:
        """Append the news to the file; if it cannot be written, the simulation goes on without."""
        if self._file is None:
            return
        try:
            self._file.writelines(json.dumps(line, separators=(",", ":")) + "\n"
                                  for line in self._news())
        except OSError as error:
            rospy.logwarn("parameter %s: %s: %s; no more is recorded",
                          rospy.resolve_name(names.RECORDING), self._file.name, error.strerror)
            self._file = None

    def _news(self) -> list[dict]:
        world, lines = self._world, []
        if world.scene.version != self._version:
            self._version = world.scene.version
            lines.append({"scene": scene_to_text(world.update_scene())})
        models = world.models.values()
        static = [model for model in models if model.static]
        self._moved |= {model.name for model in static
                        if self._placed.setdefault(model.name, model.pose) != model.pose}
        free = _links(model for model in models if not model.static)
        scripted = _links(model for model in static if model.name in self._moved)
        found = [link.scoped_name for link in (*free, *scripted)]
        if found != self._names:
            self._names = found
            lines.append({"names": found, "scripted": len(scripted)})
        return [*lines, {"time": round(world.time, 9), "poses": [
            [round(value, DIGITS) for value in (*link.pose.position, *link.pose.orientation)]
            for link in (*free, *scripted)]}]


def _links(models: Iterable[Model]) -> list[Link]:
    return [link for model in models for link in NestedModel(model).links()]
