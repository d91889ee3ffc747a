"""What is driven: world, robot, way-points and rules for goals, from a file of houses/."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from run_session.resources import Length, find_package, load_record, located
from trial_worlds.ground import Ground


@dataclass(frozen=True)
class House:
    """A house file, key by key; m and rad, in the world's frame."""

    world: str  # path, or package://PACKAGE/PATH
    model: str  # of TurtleBot3
    start: tuple[float, float, float]
    laser_height: Length
    laser_reach: Length  # beyond it walls are not mapped
    passable: Length  # from a wall to the robot's reference point, at least
    max_speed: Length  # m/s
    goal_clearance: Length  # from a wall to a drawn goal, at least
    goal_distance: Length  # from one drawn goal to the next, at least
    way_points: tuple[tuple[float, float], ...]  # of the mapping round

    @property
    def world_path(self) -> Path:
        """Where the world file is."""
        return located(self.world).resolve()

    def ground(self) -> Ground:
        """Its true walls; WorldError for a file that is no world."""
        return Ground(self.world_path, self.start, self.laser_height, self.passable,
                      self.goal_clearance, self.goal_distance)


def load_house(name: str) -> House:
    """House `name` of houses/, or the file of that path; RunError names file and key."""
    return load_record(House, name, find_package("evaluation") / "houses")
