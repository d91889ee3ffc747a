"""The courses as Gymnasium environments."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from driving_courses.course import CourseSpec, load_course
from driving_courses.errors import CourseError
from driving_courses.features import feature_count, find_features
from driving_courses.randomisation import Randomisation, draw
from driving_courses.simulation import Simulation
from driving_courses.tasks import open_task

CHOICES = {"observation": ("image", "features"), "action": ("twist", "ackermann"),
           "render_mode": (None, "rgb_array")}
IMAGE_SIZE = (84, 84)  # px, width and height, where nothing else is asked for


class CourseEnv(gymnasium.Env):
    """A robot on a course; a step is the time from one picture of its camera to the next."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 30}

    def __init__(self, course: str | Path, observation: str = "image",
                 size: tuple[int, int] | None = None, action: str = "twist", laps: int = 1,
                 duration: float = 300.0, timestep: float | None = None,
                 render_mode: str | None = None,
                 randomise: Randomisation | Mapping[str, Any] | None = None):
        """CourseError for an option that is not possible.

        course: a name in courses/, or a YAML file.
        observation: "image", (height, width, 3) uint8 RGB; "features", see `find_features`.
        size: width and height of the picture, px; (84, 84), for features as the course says.
        action: "twist", m/s and rad/s; "ackermann", m/s and rad of the front wheel; left positive.
        laps: after which an episode ends; duration: simulated s after which it is truncated.
        timestep: s of one step of the engine, at most 0.005; None: as in ROS, 0.001.
        randomise: a `Randomisation`, or a mapping with some of its keys.
        """
        for name, value in (("observation", observation), ("action", action),
                            ("render_mode", render_mode)):
            if value not in CHOICES[name]:
                known = ", ".join(map(repr, CHOICES[name]))
                raise CourseError(f"{name}: must be one of {known}, is {value!r}")
        self.course, self.render_mode = load_course(course), render_mode
        self._features = self.course.features if observation == "features" else None
        self._ackermann = action == "ackermann"
        self._ranges = Randomisation.of(randomise)
        self._task = open_task(self.course, _whole("laps", laps))
        size = size or (self.course.features.size if self._features else IMAGE_SIZE)
        width, height = (_whole("size", side) for side in size)
        if timestep is not None and not 0.0005 <= timestep <= 0.005:
            raise CourseError(f"timestep: must be from 0.0005 to 0.005 s, is {timestep!r}")
        self._simulation = Simulation(self.course, (width, height), timestep)
        self._most_steps = _whole("duration", round(duration * self._simulation.rate_hz))
        self.action_space = _actions(self.course, self._ackermann)
        self._bounds = self.action_space.low.tolist(), self.action_space.high.tolist()
        self.observation_space = spaces.Box(0, 255, (height, width, 3), np.uint8)
        if self._features:
            self.observation_space = spaces.Box(
                -1.0, 1.0, (feature_count(self._features),), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None
              ) -> tuple[np.ndarray, dict[str, Any]]:
        """A new episode. One seed gives equal bits, whatever was driven before."""
        super().reset(seed=seed)
        self._steps = 0
        episode = draw(self._ranges, self.np_random)
        world, start = self._task.begin(episode)
        self._simulation.begin(world, start, episode)
        self._task.score(self._simulation.sample())
        return self._observe(), self._task.report()

    def step(self, action: np.ndarray
             ) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """One picture on; actions beyond the space's bounds count as the bounds."""
        speed, turn = (min(max(value, low), high) for value, low, high in
                       zip(np.asarray(action, float).tolist(), *self._bounds, strict=True))
        self._simulation.drive(speed, turn, self._ackermann)
        reward, over = self._task.score(self._simulation.sample())
        self._steps += 1
        late = self._steps >= self._most_steps
        return self._observe(), float(reward), over, late and not over, self._task.report()

    def render(self) -> np.ndarray | None:
        """The last picture, (height, width, 3) uint8 RGB."""
        return self._picture if self.render_mode else None

    def close(self) -> None:
        """Let go of the engine and the renderer."""
        self._simulation.close()

    def _observe(self) -> np.ndarray:
        self._picture = self._simulation.picture()
        return find_features(self._picture, self._features) if self._features else self._picture


def _actions(course: CourseSpec, ackermann: bool) -> spaces.Box:
    most = course.steering_angle if ackermann else course.turn
    slowest, fastest = course.speeds
    return spaces.Box(np.array([slowest, -most], np.float32),
                      np.array([fastest, most], np.float32))


def _whole(name: str, value: Any) -> int:
    if not isinstance(value, int | np.integer) or value < 1:
        raise CourseError(f"{name}: must be a whole number, 1 or more, is {value!r}")
    return int(value)
