"""A mask of a lane's lines that is robust to shade: line_mask(grey), on the painted track."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from driving_courses.course import load_course
from driving_courses.packages import find_file
from driving_courses.resources import resources
from lane_keeping.binarise import opening, region
from lane_keeping.methods.sliding_windows import plan
from lane_keeping.road_view import RoadView, road_view
from lane_keeping.settings import load_settings
from racecar_description.track.closed_line import Track, load_track

from bullet_sim.formats.loading import load_world
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.world import World
from exercises.finding import Finding, at_least
from exercises.program import load, mask_of, part

SIZE = 640, 480  # px
CALL = "line_mask(grey)"


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
            view = CameraView(*SIZE, settings.camera_hfov, 0.02, 50.0, Pose.from_xyz_rpy(
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


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The lesson's sliding windows must find the lane's middle in the mask, all round the track."""
    line_mask = part(load(file), CALL)
    settings = load_settings(find_file("lane_keeping/config/lane_keeping.yaml"))
    view, track = road_view(settings, *SIZE), load_track(load_course("lane").track_file)
    right, count = 0, round(limits["places"])
    for pose, picture in pictures(count):
        grey = cv2.cvtColor(region(picture, settings.roi_share), cv2.COLOR_BGR2GRAY)
        mask = mask_of(line_mask(grey), grey.shape, CALL).astype(np.uint8) * 255
        found = plan(opening(mask, settings.opening_px), view, settings)
        right += found is not None and beside(found.target, pose, view, track) < limits["aside"]
    yield at_least(f"share of {count} places with the lane's middle found within"
                   f" {limits['aside']:g} m", right / count, limits["right_share"])
