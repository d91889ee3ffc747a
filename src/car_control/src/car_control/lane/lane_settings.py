"""The settings of lane_follow: camera, line, and how to drive."""

from __future__ import annotations

from dataclasses import dataclass

from car_control.settings import bounded


@dataclass(frozen=True)
class LaneSettings:
    """SI units; the camera's pose is from the ground below the middle of the rear axle."""

    camera_forward: float = bounded(-2, 2, "m")
    camera_left: float = bounded(-2, 2, "m")
    camera_height: float = bounded(0.02, 3, "m")
    camera_pitch: float = bounded(-0.5, 1.5, "rad, downwards positive")
    camera_hfov: float = bounded(0.2, 3, "rad, horizontal field of view")
    line_width: float = bounded(0.005, 0.5, "m")
    line_contrast: float = bounded(1, 255, "least difference of min(red, green) and blue, of 255")
    sight: float = bounded(0.3, 10, "m from the camera, farthest place searched")

    wheelbase: float = bounded(0.05, 5, "m")
    max_steering_angle: float = bounded(0.05, 1.2, "rad")
    latency: float = bounded(0, 0.5, "s from image to wheels")
    kp: float = bounded(0, 50, "rad of steering per m of error")
    ki: float = bounded(0, 50, "rad per m s")
    kd: float = bounded(0, 50, "rad s per m")
    derivative_time: float = bounded(0, 1, "s, time constant of the derivative's low-pass")

    max_speed: float = bounded(0, 20, "m/s")
    lateral_acceleration: float = bounded(0.1, 20, "m/s^2 in bends")
    acceleration: float = bounded(0.1, 20, "m/s^2")
    braking: float = bounded(0.1, 20, "m/s^2")
    error_slowdown: float = bounded(0.01, 10, "m of error that halves the speed")
    search_speed: float = bounded(0, 5, "m/s at the line's end or while it is lost")
    search_time: float = bounded(0, 60, "s of searching before it stops")
    image_timeout: float = bounded(0.1, 10, "s without an image before it stops")
