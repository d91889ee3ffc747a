"""A method's processor time per image, on images of the ground along the lane.

The images show only the painted ground, as the car's camera sees it. They are drawn here, so the
measurement needs no simulator and does not depend on the machine's other load.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import rospkg
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import load_track_file

from lane_keeping.lane_keeper import LaneKeeper
from lane_keeping.road_view import RoadView, road_view
from lane_keeping.settings import load_settings
from lane_keeping.world.ground import draw_ground, plane_of
from lane_keeping.world.scenery import config_folder, load_crossings, load_scenery

PICTURES, WARM_UP = 40, 5
SIZE = (640, 480)  # px
PERIOD = 1 / 30  # s
SKY = (210, 190, 160)  # BGR


def ms_a_frame(method: str) -> float:
    """Median processor time (ms) from an image to its command, on one thread."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    settings = load_settings(config_folder() / "lane_keeping.yaml")
    keeper, times = LaneKeeper(replace(settings, method=method)), []
    try:
        for number, picture in enumerate(pictures(road_view(settings, *SIZE))):
            begun = time.process_time()
            keeper.step(picture, number * PERIOD)
            times.append(time.process_time() - begun)
    finally:
        cv2.setNumThreads(threads)
    return 1000 * float(np.median(times[WARM_UP:]))


def pictures(view: RoadView) -> list[np.ndarray]:
    """BGR images (480, 640, 3) from places all along the lane's middle."""
    tracks = Path(rospkg.RosPack().get_path("evaluation")) / "tracks"
    track_file = load_track_file(tracks / "lane.yaml")
    ground = draw_ground(track_file, load_crossings(), load_scenery())[..., ::-1].copy()
    plane, track = plane_of(track_file), build_track(track_file)
    scale = ground.shape[1] / plane.width
    corner = np.array((plane.x - plane.width / 2, plane.y + plane.height / 2))
    marks = np.array([(0, view.rows - 1), (view.width, view.rows - 1),
                      (0, view.rows / 2), (view.width, view.rows / 2)], float)
    seen = view.to_ground(marks)
    found = []
    for number in range(PICTURES):
        x, y, heading = track.pose(number * track.length / PICTURES)
        turn = np.array([(math.cos(heading), math.sin(heading)),
                         (-math.sin(heading), math.cos(heading))])
        on_ground = (seen @ turn + (x, y) - corner) * (scale, -scale)
        in_picture = marks + np.array((0, view.top))
        warp = cv2.getPerspectiveTransform(
            on_ground.astype(np.float32), in_picture.astype(np.float32))
        picture = cv2.warpPerspective(ground, warp, SIZE, borderValue=SKY)
        picture[:max(math.ceil(view.horizon), 0)] = SKY
        found.append(picture)
    return found
