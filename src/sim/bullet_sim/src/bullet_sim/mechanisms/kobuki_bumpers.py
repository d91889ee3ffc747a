"""Finds the pressed bumpers of a round robot's three, from its contacts."""

import math
from collections.abc import Iterable

from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import Pose

# kobuki's: contacts below these heights are the floor, above them parts on the base
LOWEST, HIGHEST = 0.01, 0.13  # m above the model frame
SECTORS = {"left": (math.pi / 6, math.pi / 2), "center": (-math.pi / 6, math.pi / 6),
           "right": (-math.pi / 2, -math.pi / 6)}  # rad from straight ahead, counter-clockwise


def pressed_bumpers(contacts: Iterable[Contact], link: str, robot: Pose) -> set[str]:
    """Names of `SECTORS`; `link` is the bumper's scoped name, `robot` the model frame."""
    pressed = set()
    heading = robot.rpy()[2]
    for contact in contacts:
        if link not in contact.links:
            continue
        sign = -1.0 if contact.links[0] == link else 1.0  # from the robot outwards
        if not LOWEST <= contact.position[2] - robot.position[2] <= HIGHEST:
            continue
        angle = math.remainder(
            math.atan2(sign * contact.normal[1], sign * contact.normal[0]) - heading, math.tau)
        pressed |= {name for name, (low, high) in SECTORS.items() if low <= angle <= high}
    return pressed
