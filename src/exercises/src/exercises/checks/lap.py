"""A lap on learning_topic's course in the simulator's core, image by image, without ROS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from driving_courses.course import load_course
from driving_courses.randomisation import Randomisation, draw
from driving_courses.simulation import Simulation
from driving_courses.tasks import LapTask

from exercises.finding import Finding, at_least, at_most, holds
from exercises.program import load, numbers, part

SIZE = 320, 180  # px
TIMESTEP = 0.004  # s, of the engine
LONGEST = 90.0  # simulated s
CALL = "Driver().drive(image, time)"


def drive(driver: Any, off_course: float) -> dict[str, Any]:
    """LapTask's report of a lap driven by driver.drive(BGR image, s) -> m/s, rad/s."""
    course = load_course("line_follow")
    task, simulation = LapTask(course, 1), Simulation(course, SIZE, TIMESTEP)
    episode = draw(Randomisation(), np.random.default_rng(0))
    try:
        simulation.begin(*task.begin(episode), episode)
        over = False
        while not over and simulation.sample().time < LONGEST:
            picture = np.ascontiguousarray(simulation.picture()[:, :, ::-1])
            answer = driver.drive(picture, simulation.sample().time)
            simulation.drive(*numbers(answer, 2, CALL), ackermann=False)
            _, over = task.score(simulation.sample())
            over = over or abs(task.report()["lateral_m"]) > off_course
    finally:
        simulation.close()
    return task.report()


def look(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """The lap must be completed, fast enough, and close to the line."""
    report = drive(part(load(file), "Driver()")(), limits["off_course"])
    closed = bool(report["lap_times_s"])
    yield holds("the lap", "closed" if closed else
                f"ended after {report['progress_m']:.1f} m, {report['lateral_m']:+.2f} m beside",
                "closed", closed)
    speed = report["distance_m"] / report["lap_times_s"][0] if closed else math.nan
    yield at_least("mean speed", speed, limits["speed"], " m/s")
    yield at_most("distance from the line, RMS", report["rms_lateral_m"], limits["rms"], " m")
