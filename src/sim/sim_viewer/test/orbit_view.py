"""What a camera sees of a place in the middle of its picture, worked out from where it stands."""

from __future__ import annotations

import math

import numpy as np

from bullet_sim.pose import Pose, Quaternion


def axes(yaw: float, pitch: float, frame: Pose) -> np.ndarray:
    """Right, up and towards the camera, in a frame; yaw and pitch as rviz's Orbit has them."""
    towards = np.array([math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw),
                        math.sin(pitch)])
    right = np.array([-math.sin(yaw), math.cos(yaw), 0.0])
    return np.array([right, np.cross(towards, right), towards]) @ frame.matrix()[:3, :3]


def below(pixels: float, pixel: float, distance: float, pitch: float) -> float:
    """m, on the level, to what is seen so far below; `pixel`: the size of one at 1 m, in m."""
    steeper = math.atan(pixels * pixel)
    return distance * math.sin(steeper) / math.sin(pitch + steeper)


def turn(axis: np.ndarray, angle: float) -> Quaternion:
    """About an axis of length 1."""
    return (*map(float, math.sin(angle / 2) * axis), math.cos(angle / 2))


def angle_between(one: Quaternion, other: Quaternion) -> float:
    """rad, by which one must be turned to be the other."""
    return 2 * math.acos(min(1.0, abs(float(np.dot(one, other)))))
