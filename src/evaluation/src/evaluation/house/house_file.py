"""A file of houses/: world, robot, waypoints and rules for goals."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from run_session.resources import Length, find_package, load_record, located
from trial_worlds.ground import Ground


@dataclass(frozen=True)
class House:
    """A house file, key by key; m and rad, in the world's frame."""

    world: str  # path, or package://PACKAGE/PATH
    model: str  # TurtleBot3 model
    start: tuple[float, float, float]
    laser_height: Length
    laser_reach: Length  # beyond it walls are not mapped
    passable: Length  # least distance from a wall to the robot's reference point
    max_speed: Length  # m/s
    goal_clearance: Length  # least distance from a wall to a random goal
    goal_distance: Length  # least distance from one random goal to the next
    way_points: tuple[tuple[float, float], ...]  # of the mapping drive

    @property
    def world_path(self) -> Path:
        """Where the world file is."""
        return located(self.world).resolve()

    def ground(self) -> Ground:
        """Its true walls; WorldError if the file is not a world."""
        return Ground(self.world_path, self.start, self.laser_height, self.passable,
                      self.goal_clearance, self.goal_distance)


def load_house(name: str) -> House:
    """House `name` of houses/, or the file of that path; RunError names file and key."""
    return load_record(House, name, find_package("evaluation") / "houses")
