"""A recording of what was to be seen, as lines of JSON in a file, from which a run is shown again.

A line is one of
    {"scene": SCENE}, a text of bullet_sim.rendering.scene_text; again when it has changed
    {"names": [MODEL::LINK, ...]} of the links that can move; again when they have changed
    {"time": s, "poses": [[x, y, z, qx, qy, qz, qw], ...]} in their order, in the world frame, m
A second simulation appends to the file of the first.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TextIO

import rospy

from bullet_sim.nested import NestedModel
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
        self._file: TextIO | None = path.open("a", encoding="utf-8", buffering=1)
        simulation.scheduler.add(RATE_HZ, self._write_state)

    def _write_state(self) -> None:
        """Nobody is judged by it: if it cannot be written, the simulation goes on without."""
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
        links = {link.scoped_name: link.pose for model in world.models.values()
                 if not model.static for link in NestedModel(model).links()}
        if list(links) != self._names:
            self._names = list(links)
            lines.append({"names": self._names})
        return [*lines, {"time": round(world.time, 9), "poses": [
            [round(value, DIGITS) for value in (*pose.position, *pose.orientation)]
            for pose in links.values()]}]
