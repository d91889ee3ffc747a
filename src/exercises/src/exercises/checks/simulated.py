"""Programs and settings in the simulator's core, without ROS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from driving_courses.course import load_course
from driving_courses.drives import RacecarDrive
from driving_courses.packages import find_file
from driving_courses.randomisation import Randomisation, draw
from driving_courses.resources import package_folder, resources
from driving_courses.simulation import Simulation
from driving_courses.tasks import LapTask
from lane_keeping.binarise import opening, region
from lane_keeping.methods.sliding_windows import plan
from lane_keeping.road_view import RoadView, road_view
from lane_keeping.settings import load_settings
from node_basics.records import read_yaml
from racecar_description.track.closed_line import Track, load_track

from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xml_values import parse_xml
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.world import World
from exercises.finding import CannotCheck, Finding, Mistake, at_least, at_most, holds, near
from exercises.program import load, mask_of, numbers, part

LAP_SIZE = 320, 180  # px
TIMESTEP = 0.004  # s, of the engine
LONGEST = 90.0  # simulated s
LAP_CALL = "Driver().drive(image, time)"


def drive(driver: Any, off_course: float) -> dict[str, Any]:
    """LapTask's report of a lap driven by driver.drive(BGR image, s) -> m/s, rad/s."""
    course = load_course("line_follow")
    task, simulation = LapTask(course, 1), Simulation(course, LAP_SIZE, TIMESTEP)
    episode = draw(Randomisation(), np.random.default_rng(0))
    try:
        simulation.begin(*task.begin(episode), episode)
        over = False
        while not over and simulation.sample().time < LONGEST:
            picture = np.ascontiguousarray(simulation.picture()[:, :, ::-1])
            answer = driver.drive(picture, simulation.sample().time)
            simulation.drive(*numbers(answer, 2, LAP_CALL), ackermann=False)
            _, over = task.score(simulation.sample())
            over = over or abs(task.report()["lateral_m"]) > off_course
    finally:
        simulation.close()
    return task.report()


def lap(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A lap on learning_topic's course in the simulator's core, image by image, without ROS.

    The lap must be completed, fast enough, and close to the line.
    """
    report = drive(part(load(file), "Driver()")(), limits["off_course"])
    closed = bool(report["lap_times_s"])
    yield holds("the lap", "closed" if closed else
                f"ended after {report['progress_m']:.1f} m, {report['lateral_m']:+.2f} m beside",
                "closed", closed)
    speed = report["distance_m"] / report["lap_times_s"][0] if closed else math.nan
    yield at_least("mean speed", speed, limits["speed"], " m/s")
    yield at_most("distance from the line, RMS", report["rms_lateral_m"], limits["rms"], " m")


LANE_SIZE = 640, 480  # px
LANE_CALL = "line_mask(grey)"


def pictures(count: int) -> Iterator[tuple[tuple[float, float, float], np.ndarray]]:
    """Yields poses (x, y, yaw) in the lane's middle, each with the car's camera image, BGR."""
    course = load_course("lane")
    settings = load_settings(find_file("lane_keeping/config/lane_keeping.yaml"))
    track = load_track(course.track_file)
    world = World(load_world(find_file(course.world), resources(course)))
    renderer = open_renderer()
    try:
        for place in range(count):
            x, y, yaw = track.pose(track.length * place / count)
            lens = (x + settings.camera_forward * math.cos(yaw),
                    y + settings.camera_forward * math.sin(yaw), settings.camera_height)
            view = CameraView(*LANE_SIZE, settings.camera_hfov, 0.02, 50.0, Pose.from_xyz_rpy(
                lens, (0.0, settings.camera_pitch, yaw)))
            rgb = renderer.draw(world.update_scene(), view).rgb
            yield (x, y, yaw), cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR)
    finally:
        renderer.close()
        world.close()


def beside(pixel: tuple[float, float], pose: tuple[float, float, float], view: RoadView,
           track: Track) -> float:
    """Distance (m) from the lane's middle to the ground point at a pixel."""
    ahead, left = view.to_ground(np.array(pixel))
    x, y, yaw = pose
    return abs(track.nearest(x + ahead * math.cos(yaw) - left * math.sin(yaw),
                             y + ahead * math.sin(yaw) + left * math.cos(yaw)).lateral)


def lane(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A mask of a lane's lines that is robust to shade: line_mask(grey), on the painted track.

    The lesson's sliding windows must find the lane's middle in the mask, all round the track.
    """
    line_mask = part(load(file), LANE_CALL)
    settings = load_settings(find_file("lane_keeping/config/lane_keeping.yaml"))
    view, track = road_view(settings, *LANE_SIZE), load_track(load_course("lane").track_file)
    right, count = 0, round(limits["places"])
    for pose, picture in pictures(count):
        grey = cv2.cvtColor(region(picture, settings.roi_share), cv2.COLOR_BGR2GRAY)
        mask = mask_of(line_mask(grey), grey.shape, LANE_CALL).astype(np.uint8) * 255
        found = plan(opening(mask, settings.opening_px), view, settings)
        right += found is not None and beside(found.target, pose, view, track) < limits["aside"]
    yield at_least(f"share of {count} places with the lane's middle found within"
                   f" {limits['aside']:g} m", right / count, limits["right_share"])


JOINTS = "left_steering_joint", "right_steering_joint"
MOST_GAIN = 1e9  # of P, I and D


def read(file: Path) -> None:
    """CannotCheck if it is not YAML; Mistake if a required setting is missing or wrong."""
    table = read_yaml(file, CannotCheck)
    if not isinstance(table, dict) or not isinstance(table.get("racecar"), dict):
        raise Mistake(f"{file}: its first key must be `racecar`, with controllers below it")
    for name, entry in table["racecar"].items():
        if wrong := _wrong_in(entry):
            raise Mistake(f"{file}: {name}: {wrong}")


def _wrong_in(entry: object) -> str | None:
    """A controller's missing setting, or one of a wrong type, in words; None: all are right."""
    if not isinstance(entry, dict) or not isinstance(entry.get("type"), str):
        return "lacks `type`"
    if "JointStateController" in entry["type"] and "pid" not in entry:  # it moves nothing
        return None
    if not isinstance(entry.get("joint"), str):
        return "lacks `joint`"
    gains = entry.get("pid")
    if not isinstance(gains, dict):
        return "lacks `pid`"
    for key in ("p", "i", "d"):
        if type(gains.get(key)) not in (int, float) or not abs(gains[key]) < MOST_GAIN:
            return f"`{key}` of its `pid` must be a number"
    return None


def steering(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A controllers' YAML file: the racecar's steering hinges, in the simulator's core.

    Both hinges must turn to the commanded angles, on a standing car.
    """
    read(file)
    course = load_course("race")
    text = expand(find_file(course.robot), find_package=package_folder)
    world = World(load_world(find_file(course.world), resources(course)))
    try:
        car = world.spawn(load_model(text, resources(course)),
                          Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), course.model)
        try:
            drive = RacecarDrive(world, car, parse_xml(text, course.robot), file)
            drive.command(0.0, limits["angle"])
            drive.run(world.tick + round(limits["seconds"] / world.timestep))
        except KeyError as error:
            raise Mistake(f"{file}: {error} is not a controller of this car, or missing in a pid") \
                from error
        except SimulationError as error:
            raise Mistake(f"{file}: {error}") from error
        for joint in JOINTS:
            yield near(f"{joint} after {limits['seconds']:g} s", car.joint(joint).position,
                       limits["angle"], limits["tolerance"], " rad")
    finally:
        world.close()
