"""Drives a robot into some boxes and prints, as JSON, a SHA-256 of each kind of reading.

`repeated_run.py SEED LOOK_EVERY`: every so many frames and sweeps are taken, and only these.
"""

import hashlib
import json
import struct
import sys

from bullet_sim.description import (
    Box,
    CameraDescription,
    Collision,
    Cylinder,
    Inertial,
    JointDescription,
    LightDescription,
    LinkDescription,
    ModelDescription,
    Noise,
    Plane,
    RayDescription,
    SensorDescription,
    Sphere,
    Visual,
)
from bullet_sim.drives.diff_drive import DiffDrive, DiffDriveParameters
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.sensors.camera import Camera
from bullet_sim.sensors.imu import LinkMotion
from bullet_sim.sensors.laser import Laser
from bullet_sim.world import World

SECONDS = 3.0
FRAME = 50  # steps between two frames, or sweeps
FRAMES_HASHED = 6  # every so many, so that runs that look at 1, 2 or 3 of them can be compared
RADIUS = 0.03  # m
CAMERA = SensorDescription("camera", "camera", cameras=(
    CameraDescription(1.2, 64, 48, noise=Noise("gaussian", 0.0, 0.02)),))
LASER = SensorDescription("laser", "ray", ray=RayDescription(
    samples=90, min_angle=-2.0, max_angle=2.0, range_min=0.15, range_max=3.0,
    noise=Noise("gaussian", 0.0, 0.01)))


def link(name, shape, mass, pose=IDENTITY, **fields):
    moment = mass * 0.002
    return LinkDescription(
        name, pose, Inertial(mass, inertia=(moment, 0.0, 0.0, moment, 0.0, moment)),
        visuals=(Visual(name, shape),), collisions=(Collision(name, shape),), **fields)


def robot() -> ModelDescription:
    links = [link("base", Box((0.2, 0.15, 0.05)), 2.0, Pose((0.0, 0.0, RADIUS)),
                  sensors=(CAMERA, LASER))]
    joints = []
    for side, y in (("left", 0.1), ("right", -0.1)):
        pose = Pose.from_xyz_rpy((0.0, y, RADIUS), (-1.5707963, 0.0, 0.0))
        links.append(link(side, Cylinder(RADIUS, 0.02), 0.05, pose))
        joints.append(JointDescription(f"{side}_joint", "continuous", "base", side))
    return ModelDescription("robot", links=tuple(links), joints=tuple(joints))


def fill(world: World) -> None:
    floor = Plane((0.0, 0.0, 1.0), (10.0, 10.0))
    world.spawn(ModelDescription("ground", static=True, links=(
        LinkDescription("link", visuals=(Visual("floor", floor),),
                        collisions=(Collision("floor", floor),)),)))
    world.scene.add_light(LightDescription("sun", "directional", direction=(0.3, 0.2, -1.0)))
    for number in range(4):
        shape = Sphere(0.05) if number % 2 else Box((0.1, 0.1, 0.1))
        world.spawn(ModelDescription(f"thing_{number}", links=(link("link", shape, 0.1),)),
                    Pose((0.35 + 0.1 * number, 0.08 * number, 0.1)))


def run(seed: int, look_every: int) -> dict[str, str]:
    """SHA-256 by what it is of."""
    hashes = {kind: hashlib.sha256() for kind in ("poses", "imu", "scans", "images")}
    world = World(seed=seed)
    fill(world)
    model = world.spawn(robot())
    drive = DiffDrive(model.joint("left_joint"), model.joint("right_joint"),
                      DiffDriveParameters(0.2, 2 * RADIUS, 0.0, 5.0))
    drive.command(0.3, 0.4)
    renderer = open_renderer()
    base = model.links["base"]
    camera, laser = Camera(world, base, CAMERA, renderer), Laser(world, base, LASER)
    imu = LinkMotion(world, base)
    for frame in range(1, round(SECONDS / world.timestep) // FRAME + 1):
        drive.update(FRAME * world.timestep)
        world.step(FRAME)
        if frame % look_every:
            continue
        image, scan, motion = camera.sample(), laser.sample(), imu.sample()
        if frame % FRAMES_HASHED:
            continue
        hashes["images"].update(image.rgb.tobytes())
        hashes["scans"].update(scan.ranges.tobytes())
        hashes["imu"].update(struct.pack(
            "4d3d", *motion.orientation, *motion.world_angular_velocity))
        for pose, twist in (state for m in world.models.values()
                            for state in m.link_states().values()):
            numbers = (*pose.position, *pose.orientation, *twist.linear, *twist.angular)
            hashes["poses"].update(struct.pack("13d", *numbers))
    renderer.close()
    world.close()
    return {kind: value.hexdigest() for kind, value in hashes.items()}


if __name__ == "__main__":
    print(json.dumps(run(int(sys.argv[1]), int(sys.argv[2]))))
