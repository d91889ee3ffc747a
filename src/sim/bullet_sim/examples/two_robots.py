"""Drives two robots towards each other until they touch, and prints where and how hard."""

import math
from pathlib import Path

from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.world import World

URDF = Path(__file__).with_name("robot.urdf").read_text(encoding="utf-8")
PLACES = {"a": Pose((-0.5, 0.0, 0.04)),
          "b": Pose.from_xyz_rpy((0.5, 0.0, 0.04), (0.0, 0.0, math.pi))}


def main() -> None:
    """Each drives at 0.2 m/s; they start 1 m apart."""
    resources = Resources.from_environment()
    world = World(load_world(resources.find_world("worlds/empty.world"), resources))
    parameters = DiffDriveParameters(wheel_separation=0.22, wheel_diameter=0.08)
    for name, pose in PLACES.items():
        robot = world.spawn(load_model(URDF, resources), pose, name)
        drive = DiffDrive(robot.joint("left_joint"), robot.joint("right_joint"), parameters)
        drive.command(0.2, 0.0)
        drive.update(world.timestep)  # once is enough without acceleration limits
    while world.time < 5.0:
        world.step()
        for contact in world.contacts():
            models = {name.split("::")[0] for name in (contact.collision1, contact.collision2)}
            if models == {"a", "b"}:
                print(f"a and b touch after {world.time:.2f} s at x {contact.position[0]:.3f} m "
                      f"with {math.hypot(*contact.force):.0f} N")
                return world.close()
    print("they did not meet")


if __name__ == "__main__":
    main()
