"""Writes the image of the robot's camera as a PNG: take_picture.py [FILE]."""

import sys
from pathlib import Path

import cv2

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import Pose
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.sensors.camera import Camera
from bullet_sim.world import World

URDF = Path(__file__).with_name("robot.urdf").read_text(encoding="utf-8")


def main(file: str) -> None:
    """Two models of the library stand in front of the robot."""
    resources = Resources.from_environment()
    world = World(load_world(resources.find_world("worlds/empty.world"), resources))
    robot = world.spawn(load_model(URDF, resources), Pose((0.0, 0.0, 0.04)))
    for name, place in (("construction_cone", (1.5, 0.3, 0.0)), ("beer", (0.7, -0.2, 0.0))):
        text = resources.resolve(f"model://{name}/model.sdf").read_text(encoding="utf-8")
        world.spawn(load_model(text, resources), Pose(place))
    link = robot.link("base")
    sensor = next(each for each in link.description.sensors if each.type == "camera")
    reading = Camera(world, link, sensor, open_renderer()).sample()
    if not cv2.imwrite(file, cv2.cvtColor(reading.rgb, cv2.COLOR_RGB2BGR)):
        sys.exit(f"{file} cannot be written; give the name of a .png in a folder that is there")
    print(f"{file}: {reading.rgb.shape[1]} x {reading.rgb.shape[0]} pixels")
    world.close()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "picture.png")
