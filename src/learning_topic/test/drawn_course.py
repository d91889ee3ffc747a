"""A drawn course: a closed line with bends, the waffle's view of it, and how the waffle moves."""

import math

import cv2
import numpy as np

WIDTH, HEIGHT = 1920, 1080  # px
FOCAL = WIDTH / 2 / math.tan(1.3439 / 2)  # px
CAMERA = (0.069, -0.047, 0.117)  # m, from base_footprint: forward, left, up
LINE_WIDTH = 0.018  # m
TOP = 800  # px; rows above it are never drawn, no lesson looks there
CORNERS = (  # x, y, radius in m; driven in this order, clockwise
    (-1.5, 1.5, 0.8), (0.2, 1.5, 0.6), (0.2, 0.3, 0.5),
    (1.5, 0.3, 1.1), (1.5, -1.5, 0.6), (-1.5, -1.5, 0.7),
)
STEP = 0.01  # m between two points of the line
WHEEL_DISTANCE = 0.287  # m
WHEEL_ACCELERATION = 1.0  # m/s²
LATENCY = 0.06  # s from what the camera saw to the wheels
FRAME = 1 / 30  # s


def rounded(corners, step=STEP):
    """Points (n, 2) every step along the polygon with its corners rounded."""
    points = []
    for i, (x, y, radius) in enumerate(corners):
        here = np.array((x, y))
        back = np.array(corners[i - 1][:2]) - here
        ahead = np.array(corners[(i + 1) % len(corners)][:2]) - here
        back, ahead = back / np.linalg.norm(back), ahead / np.linalg.norm(ahead)
        half = math.acos(np.clip(back @ ahead, -1, 1)) / 2
        middle = here + (back + ahead) / np.linalg.norm(back + ahead) * radius / math.sin(half)
        start, end = (here + side * radius / math.tan(half) for side in (back, ahead))
        first, last = (math.atan2(*(point - middle)[::-1]) for point in (start, end))
        turn = (last - first + math.pi) % (2 * math.pi) - math.pi
        angles = first + np.linspace(0, turn, 100)
        points.append(middle + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    points = np.vstack([*points, points[0][:1]])
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    even = np.arange(0, way[-1], step)
    return np.stack([np.interp(even, way, points[:, k]) for k in (0, 1)], axis=1)


class DrawnCourse:
    """The line on the floor, what the camera sees of it, and how far from it a pose is."""

    def __init__(self, corners=CORNERS):
        self.line = rounded(corners)
        ahead = np.roll(self.line, -1, axis=0) - self.line
        self.along = ahead / np.linalg.norm(ahead, axis=1)[:, None]
        left = np.stack([-self.along[:, 1], self.along[:, 0]], axis=1) * LINE_WIDTH / 2
        self.edges = np.stack([self.line + left, self.line - left], axis=1)
        self.image = np.zeros((HEIGHT, WIDTH, 3), np.uint8)

    def start(self):
        """A pose (x, y, yaw) on the longest straight, along the line."""
        i = len(self.line) - 40
        return (*self.line[i], math.atan2(self.along[i][1], self.along[i][0]))

    def view(self, pose):
        """The BGR image at this pose; the same array each time."""
        x, y, yaw = pose
        c, s = math.cos(yaw), math.sin(yaw)
        floor = (self.edges - (x, y)) @ np.array([[c, -s], [s, c]]) - CAMERA[:2]
        seen = (floor[:, :, 0] > 0.1).all(axis=1) & (floor[:, 0, 0] < 0.6)
        ahead, left = np.where(seen[:, None, None], floor, 1.0).transpose(2, 0, 1)
        pixels = np.stack([WIDTH / 2 - FOCAL * left / ahead,
                           HEIGHT / 2 + FOCAL * CAMERA[2] / ahead], axis=2)
        following = np.roll(pixels, -1, axis=0)
        quads = np.stack([pixels[:, 0], pixels[:, 1], following[:, 1], following[:, 0]], axis=1)
        quads = quads[seen & np.roll(seen, -1)]
        self.image[TOP:] = 0
        for quad in np.rint(quads * 16).astype(np.int32):
            cv2.fillConvexPoly(self.image, quad, (0, 255, 255), shift=4)
        return self.image

    def beside(self, pose):
        """Distance to the line in m (left of it positive) and the index of its nearest point."""
        away = np.array(pose[:2]) - self.line
        i = int(np.argmin((away**2).sum(axis=1)))
        return self.along[i][0] * away[i][1] - self.along[i][1] * away[i][0], i


class Waffle:
    """Two wheels that speed up no faster than they can, told by commands that arrive late."""

    def __init__(self, pose):
        self.pose = pose
        self.wheels = np.zeros(2)  # m/s, left and right
        self.wanted = np.zeros(2)
        self.late = []  # (time, left, right)

    def command(self, time, speed, turn):
        half = turn * WHEEL_DISTANCE / 2
        self.late.append((time + LATENCY, speed - half, speed + half))

    def step(self, time, dt):
        while self.late and self.late[0][0] <= time:
            self.wanted = np.array(self.late.pop(0)[1:])
        change = WHEEL_ACCELERATION * dt
        self.wheels = self.wheels + np.clip(self.wanted - self.wheels, -change, change)
        speed, turn = self.wheels.mean(), (self.wheels[1] - self.wheels[0]) / WHEEL_DISTANCE
        x, y, yaw = self.pose
        yaw += turn * dt
        self.pose = (x + speed * math.cos(yaw) * dt, y + speed * math.sin(yaw) * dt, yaw)


def drive(course, follow, limit=150.0, beside=0.0):
    """One lap by follow(image, time) -> (speed, turn); distances from the line in m, one a frame.

    Raises AssertionError with time and place when the car leaves the line or the time is up.
    """
    x, y, yaw = course.start()
    waffle = Waffle((x - beside * math.sin(yaw), y + beside * math.cos(yaw), yaw))
    distances, way, last = [], 0, course.beside(waffle.pose)[1]
    steps = 10
    for frame in range(int(limit / FRAME)):
        time = frame * FRAME
        waffle.command(time, *follow(course.view(waffle.pose), time))
        for k in range(steps):
            waffle.step(time + k * FRAME / steps, FRAME / steps)
        distance, here = course.beside(waffle.pose)
        count = len(course.line)
        way += (here - last + count // 2) % count - count // 2
        last = here
        distances.append(distance)
        assert abs(distance) < 0.3, f"left the line at {time:.1f} s, {waffle.pose}"
        if way >= count:
            return np.array(distances)
    raise AssertionError(f"no lap in {limit} s; stands at {waffle.pose}")
