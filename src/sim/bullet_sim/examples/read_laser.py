"""Prints the distance and direction of the nearest object that the robot's laser sees."""

from pathlib import Path

import numpy as np

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.sensors.laser import Laser
from bullet_sim.world import World

URDF = Path(__file__).with_name("robot.urdf").read_text(encoding="utf-8")


def main() -> None:
    """A box of 1 m stands 2 m ahead of the robot and 1 m to its left."""
    resources = Resources.from_environment()
    world = World(load_world(resources.find_world("worlds/empty.world"), resources))
    robot = world.spawn(load_model(URDF, resources), Pose((0.0, 0.0, 0.04)))
    box = resources.resolve("model://unit_box/model.sdf").read_text(encoding="utf-8")
    world.spawn(load_model(box, resources), Pose((2.0, 1.0, 0.0)))
    link = robot.link("base")
    sensor = next(each for each in link.description.sensors if each.type == "ray")
    reading = Laser(world, link, sensor).sample()
    beams = np.linspace(reading.angle_min, reading.angle_max, len(reading.ranges))
    hit = np.isfinite(reading.ranges)
    nearest = int(np.argmin(reading.ranges))
    print(f"{np.count_nonzero(hit)} of {len(hit)} beams hit something; the nearest is "
          f"{reading.ranges[nearest]:.2f} m away at {np.degrees(beams[nearest]):.0f} degrees")
    world.close()


if __name__ == "__main__":
    main()
