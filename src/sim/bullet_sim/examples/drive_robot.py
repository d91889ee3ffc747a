"""Loads a robot from its URDF, drives it on an arc for 4 s and prints where it is."""

from pathlib import Path

from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.world import World

URDF = Path(__file__).with_name("robot.urdf").read_text(encoding="utf-8")
PERIOD = 0.01  # s between two updates of the drive


def main() -> None:
    """Prints a line for each simulated second."""
    resources = Resources.from_environment()
    world = World(load_world(resources.find_world("worlds/empty.world"), resources))
    robot = world.spawn(load_model(URDF, resources), Pose((0.0, 0.0, 0.04)))
    drive = DiffDrive(robot.joint("left_joint"), robot.joint("right_joint"),
                      DiffDriveParameters(wheel_separation=0.22, wheel_diameter=0.08))
    drive.command(0.2, 0.4)  # m/s, rad/s
    steps = round(PERIOD / world.timestep)
    for update in range(1, 401):
        drive.update(PERIOD)
        world.step(steps)
        if update % 100 == 0:
            x, y, _ = robot.pose.position
            print(f"{world.time:.2f} s: x {x:.3f} m, y {y:.3f} m, yaw {robot.pose.rpy()[2]:.3f}")
    world.close()


if __name__ == "__main__":
    main()
