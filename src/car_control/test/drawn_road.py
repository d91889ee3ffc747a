"""A drawn road with a yellow line, the racecar's view of it, and how the racecar moves."""

import math

import cv2
import numpy as np
from racecar_description.track.centre_line import Corner
from racecar_description.track.closed_line import Track, build_track
from racecar_description.track.track_file import TrackFile

LAWN, ASPHALT, WHITE, YELLOW, SKY = (
    (60, 110, 64), (56, 53, 52), (235, 235, 235), (20, 205, 250), (225, 190, 158),
)
ROAD, EDGE, EDGE_WIDTH = 0.9, 0.4, 0.03  # m
STEP = 0.04  # m between two points of a line
NEAR, FAR = 0.1, 5.0  # m from the camera: what is drawn
FRAME = 1 / 30  # s
STEPS = 10  # of the car's motion a frame
SPEED_TIME, HINGE_TIME = 0.08, 0.06  # s, time constants of wheels and hinges
LATENCY = 0.04  # s from the image to the controllers
WHEELBASE = 0.335  # m


def track(*corners):
    """The closed line round a polygon of (x, y, radius), in m."""
    points = tuple(Corner(*corner) for corner in corners)
    x, y = ((points[0].x + points[-1].x) / 2, (points[0].y + points[-1].y) / 2)
    return build_track(TrackFile("drawn", 12.0, 0.0, 0.05, EDGE, (x, y), points))


class Road:
    """What a camera sees of a track: lawn, asphalt, white edges, yellow middle."""

    def __init__(self, line: Track, settings, width_px=640, height_px=360):
        self.track, self.settings, self.size = line, settings, (width_px, height_px)
        self.focal = width_px / 2 / math.tan(settings.camera_hfov / 2)
        random = np.random.default_rng(0)
        self.noise = 255 * random.standard_normal((height_px, width_px, 3), np.float32)
        pose = np.array([line.pose(s) for s in np.arange(0, line.length, STEP)])
        self.points = pose[:, :2]
        self.left = np.stack([-np.sin(pose[:, 2]), np.cos(pose[:, 2])], axis=1)

    def pose(self, s=0.0, beside=0.0, turned=0.0):
        """A car's pose (x, y, yaw) at s m, so far to the left, turned so much to the left."""
        x, y, heading = self.track.pose(s)
        return x - beside * math.sin(heading), y + beside * math.cos(heading), heading + turned

    def view(self, pose, light=1.0, noise=0.0, seed=0):
        """The BGR image at this pose of the rear axle."""
        width, height = self.size
        image = np.empty((height, width, 3), np.uint8)
        horizon = int(height / 2 - self.focal * math.tan(self.settings.camera_pitch))
        image[: max(horizon, 0)], image[max(horizon, 0) :] = SKY, LAWN
        for half_outer, half_inner, colour in self._strips():
            self._paint(image, pose, half_outer, half_inner, colour)
        if noise:
            sheet = np.roll(self.noise, (17 * seed) % height, axis=0)
            return np.clip(image * np.float32(light) + noise * sheet, 0, 255).astype(np.uint8)
        return cv2.convertScaleAbs(image, alpha=light)

    def _strips(self):
        line = self.settings.line_width / 2
        edges = (EDGE - EDGE_WIDTH / 2, EDGE + EDGE_WIDTH / 2)
        return (
            (-ROAD / 2, ROAD / 2, ASPHALT), (-line, line, YELLOW),
            (*edges, WHITE), (-edges[1], -edges[0], WHITE),
        )

    def _paint(self, image, pose, low, high, colour):
        corners = np.stack([self.points + low * self.left, self.points + high * self.left], axis=1)
        pixels, visible = self._project(corners, pose)
        following, on = np.roll(pixels, -1, axis=0), np.roll(visible, -1)
        quads = np.stack([pixels[:, 0], pixels[:, 1], following[:, 1], following[:, 0]], axis=1)
        cv2.fillPoly(image, list(np.rint(quads[visible & on] * 16).astype(np.int32)), colour,
                     shift=4)

    def _project(self, ground, pose):
        """Pixels (n, 2, 2) of ground points, and which pairs (n,) lie before the camera."""
        settings = self.settings
        c, s = math.cos(pose[2]), math.sin(pose[2])
        in_car = (ground - pose[:2]) @ np.array([[c, -s], [s, c]])
        ahead = in_car[..., 0] - settings.camera_forward
        left = in_car[..., 1] - settings.camera_left
        c, s = math.cos(settings.camera_pitch), math.sin(settings.camera_pitch)
        depth = ahead * c + settings.camera_height * s
        up = ahead * s - settings.camera_height * c
        visible = ((depth > NEAR) & (np.hypot(ahead, left) < FAR)).all(axis=1)
        depth = np.where(depth > NEAR, depth, 1.0)
        pixels = np.stack([self.size[0] / 2 - self.focal * left / depth,
                           self.size[1] / 2 - self.focal * up / depth], axis=-1)
        return np.clip(pixels, -1e5, 1e5), visible


class Racecar:
    """A bicycle whose wheels and hinge follow their commands late and with a lag."""

    def __init__(self, pose):
        self.pose, self.speed, self.angle = pose, 0.0, 0.0
        self.wanted, self.late = (0.0, 0.0), []

    def command(self, time, speed, angle):
        self.late.append((time + LATENCY, speed, angle))

    def step(self, time, dt):
        while self.late and self.late[0][0] <= time + 1e-9:
            self.wanted = self.late.pop(0)[1:]
        self.speed += (self.wanted[0] - self.speed) * dt / SPEED_TIME
        self.angle += (self.wanted[1] - self.angle) * dt / HINGE_TIME
        x, y, yaw = self.pose
        yaw += self.speed * math.tan(self.angle) / WHEELBASE * dt
        self.pose = (x + self.speed * math.cos(yaw) * dt, y + self.speed * math.sin(yaw) * dt, yaw)


def drive(road, follow, start, seconds, laps=1, **view):
    """Drive with follow(image, time) -> (m/s, rad); m beside the line, one a frame, and the time.

    Ends after so many laps or seconds; AssertionError when the car leaves the road.
    """
    car, beside = Racecar(start), []
    last, way = road.track.nearest(*start[:2]).s, 0.0
    for frame in range(round(seconds / FRAME)):
        time = frame * FRAME
        car.command(time, *follow(road.view(car.pose, seed=frame, **view), time))
        for k in range(STEPS):
            car.step(time + k * FRAME / STEPS, FRAME / STEPS)
        here = road.track.nearest(*car.pose[:2])
        way += math.remainder(here.s - last, road.track.length)
        last = here.s
        beside.append(here.lateral)
        assert abs(here.lateral) < ROAD / 2, f"left the road at {time:.1f} s, {car.pose}"
        if way >= laps * road.track.length:
            break
    return np.array(beside), (frame + 1) * FRAME
