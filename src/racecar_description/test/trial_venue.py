"""Where the racecar's mapping and navigation are tried, and what the simulator knows of it."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nav_algorithms import likelihood_field
from nav_algorithms.cells import OCCUPIED
from nav_algorithms.poses import compose
from trial_worlds.house import open_walls, true_map

PACKAGE = Path(__file__).resolve().parent.parent
VENUES = ("walled", "field")
TOUCHED = "/walls_touched"  # topic of what touches a wall
LASER = np.array([0.355, 0.0, 0.0])  # in base_link
LASER_HEIGHT, LASER_ANGLES, LASER_REACH = 0.175, np.radians(np.arange(-135, 135.1, 0.5)), 10.0
FINE = 0.02  # m, cell of the map that clearances are read from
# The car's outline on the ground: bumpers, and the front wheels at full lock. m in base_link.
OUTLINE = np.array([(-0.08, -0.14), (0.28, -0.14), (0.28, -0.162), (0.39, -0.162), (0.39, -0.14),
                    (0.41, -0.14), (0.41, 0.14), (0.39, 0.14), (0.39, 0.162), (0.28, 0.162),
                    (0.28, 0.14), (-0.08, 0.14)])
SENSOR = """<sensor name="touch" type="contact"><update_rate>100</update_rate>
<contact>{collisions}</contact>
<plugin name="touch" filename="libgazebo_ros_bumper.so"><bumperTopicName>{topic}</bumperTopicName>
</plugin></sensor>"""


@dataclass(frozen=True)
class Venue:
    """A world whose walls say what touches them, and the map that was drawn with it."""

    name: str
    world: Path
    plain_world: Path  # without that
    drawn_map: Path
    models: Path

    @property
    def environment(self) -> dict[str, str]:
        """With the folder of its models."""
        known = os.environ.get("GAZEBO_MODEL_PATH", "")
        return {**os.environ, "GAZEBO_MODEL_PATH": f"{self.models}:{known}"}


def prepare(name: str, folder: Path) -> Venue:
    """"field": racetrack.world, an open field in a wall; "walled": its road between two walls."""
    root, stem = PACKAGE, "racetrack"
    if name == "walled":
        root, stem = folder / "track", "walled_racetrack"
        subprocess.run([sys.executable, PACKAGE / "scripts" / "make_track",
                        PACKAGE / "tracks" / "racetrack.yaml", "--walls", "--name", stem,
                        "--out", root], check=True, capture_output=True, timeout=60)
    plain = root / "worlds" / f"{stem}.world"
    world = folder / f"{stem}_touch.world"
    world.write_text(_with_touch(plain.read_text(encoding="utf-8")), encoding="utf-8")
    return Venue(name, world, plain, root / "maps" / f"{stem}.yaml", root / "models")


def _with_touch(text: str) -> str:
    """The world with one contact sensor for all walls; they are models of the world itself."""
    tree = ElementTree.fromstring(text)
    names = [f"{model.get('name')}::{link.get('name')}::{collision.get('name')}"
             for model in tree.iter("model") for link in model.iter("link")
             for collision in link.iter("collision")]
    listed = "".join(f"<collision>{name}</collision>" for name in names)
    link = next(tree.iter("link"))
    link.append(ElementTree.fromstring(SENSOR.format(collisions=listed, topic=TOUCHED)))
    return ElementTree.tostring(tree, encoding="unicode")


class Truth:
    """The venue's walls as the simulator has them."""

    def __init__(self, venue: Venue) -> None:
        world = open_walls(venue.plain_world)
        try:
            self.map, fine = (true_map(world, LASER_HEIGHT, [(0.0, 0.0)], cell, reach=7.5)
                              for cell in (0.05, FINE))
        finally:
            world.close()
        self._fine = fine
        self._distances = FINE * likelihood_field.distances(
            (fine.cells == OCCUPIED).astype(np.uint8))

    def clearances(self, poses: np.ndarray) -> np.ndarray:
        """Of the car's outline from the nearest wall at poses (N, 3), m, to about 2 cm."""
        points = compose(np.atleast_2d(poses)[:, None], _every(OUTLINE, FINE)[None])[..., :2]
        cells = self._fine.cells_of(points)
        inside = self._fine.contains(cells)
        found = np.zeros(inside.shape)  # also where the car has left the world
        found[inside] = self._distances[tuple(cells[inside].T)]
        return found.min(axis=1)


def _every(corners: np.ndarray, step: float) -> np.ndarray:
    """Points (N, 3) along a closed polygon, `step` or less apart, heading 0."""
    found = []
    for begin, end in zip(corners, np.roll(corners, -1, axis=0)):
        count = max(int(np.ceil(np.hypot(*(end - begin)) / step)), 1)
        found.append(begin + np.linspace(0, 1, count, endpoint=False)[:, None] * (end - begin))
    points = np.concatenate(found)
    return np.column_stack((points, np.zeros(len(points))))
