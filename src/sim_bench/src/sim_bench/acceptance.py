"""What the figures have to reach on a quiet machine, 2 cores and no GPU, and whether they do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from sim_bench.figures import Figure


@dataclass(frozen=True)
class Criterion:
    """One line; exactly one of the two bounds is given, in the figure's unit."""

    what: str
    figure: str  # PART/NAME
    at_least: float | None = None
    at_most: float | None = None
    bound_by: tuple[str, ...] = ()  # figures, or beginnings of their names: what it cannot beat

    def met(self, value: float) -> bool:
        """Whether a median is within the bound."""
        if self.at_least is not None:
            return value >= self.at_least
        return value <= self.at_most

    @property
    def bound(self) -> str:
        """As it is printed."""
        if self.at_least is not None:
            return f">= {self.at_least:g}"
        return f"<= {self.at_most:g}"


@dataclass(frozen=True)
class Verdict:
    """A criterion and the figure that was measured for it; figures of `binding` are PART/NAME."""

    criterion: Criterion
    figure: Figure
    binding: tuple[Figure, ...] = ()  # of the criterion's `bound_by`, what was measured

    @property
    def met(self) -> bool:
        """By the median."""
        return self.criterion.met(self.figure.median)


# The state that counts is the one in which all the work is done: a world at rest leaves it out.
CRITERIA = (
    Criterion("make course, real time", "ros/make_course.real_time_factor", at_least=0.95),
    Criterion("make course, frames answered", "ros/make_course.frames", at_least=28),
    Criterion("1080p, frames at lesson 05", "ros/1080p.frames", at_least=28),
    Criterion("1080p, real time", "ros/1080p.real_time_factor", at_least=0.95),
    Criterion("1080p, age at the callback", "ros/1080p.frame_age", at_most=18,
              bound_by=("ros/1080p.stage.", "ros/1080p.callback")),
    Criterion("1080p, the simulator's processor", "ros/1080p.cpu.gazebo", at_most=55,
              bound_by=("limits/flat_picture_cpu.1920x1080", "ros/1080p.stage.")),
    Criterion("720p, real time", "ros/720p.real_time_factor", at_least=0.99),
    Criterion("720p, processor to spare", "ros/720p.spare", at_least=0.5),
    Criterion("TinyRenderer against ours, 1080p", "renderer/ratio.tiny.1920x1080", at_least=35),
    Criterion("EGL plugin against ours, 1080p", "renderer/ratio.plugin.1920x1080", at_least=4),
    Criterion("off the analytic picture", "renderer/difference.max", at_most=2),
    Criterion("make course FAST=1 at 640x480", "fast/make_course.real_time_factor", at_least=8,
              bound_by=("fast/lockstep.stage.", "limits/flat_picture.640x480")),
    Criterion("lockstep at 640x480", "fast/lockstep.real_time_factor", at_least=10,
              bound_by=("fast/lockstep.stage.", "limits/flat_picture.640x480")),
    Criterion("no camera, driving", "fast/no_camera.driving.real_time_factor", at_least=30,
              bound_by=("fast/no_camera.driving.step", "fast/no_camera.driving.bare_step")),
    Criterion("eight waffles, no camera", "growth/robots.8", at_most=250,
              bound_by=("growth/physics.robots.8",)),
    Criterion("our step against bare, standing", "step/ratio.standing", at_most=1.5),
    Criterion("our step against bare, driving", "step/ratio.driving", at_most=1.5),
    Criterion("nobody subscribed, processor", "ros/idle.cpu.gazebo", at_most=5),
    Criterion("paused, processor", "ros/paused.cpu.gazebo", at_most=5),
    Criterion("roslaunch to first image", "startup/first_image", at_most=4),
    Criterion("memory growth, no camera", "memory/no_camera.growth", at_most=2),
    Criterion("memory growth, camera", "memory/camera.growth", at_most=2),
    Criterion("/clock off whole periods", "memory/clock.off_whole_periods", at_most=0),
    Criterion("/clock behind the ticks", "memory/clock.behind_ticks", at_most=10),
    Criterion("ten robots by services", "robots/spawned", at_most=5),
    Criterion("ten robots by a launch file", "robots/launched.spawned", at_most=5),
    Criterion("memory after 1000 spawns", "respawn/memory.growth", at_most=5),
    Criterion("step after 1000 spawns", "respawn/step.last_to_first", at_most=1.05),
    *(Criterion(f"{what}, real time", f"worlds/real_time_factor.{name}", at_least=bound)
      for what, name, bound in (
          ("300,000 triangles", "signs.300000", 0.99),
          ("four cameras and 16 rings", "four_cameras_and_rings", 0.99),
          ("depth camera, 640x480", "depth.640x480", 0.99),
          ("playpen, four wheels", "playpen.4_wheels", 0.99),
          ("playpen, six wheels", "playpen.6_wheels", 0.99))),
    Criterion("depth camera, 1920x1080, real time", "worlds/real_time_factor.depth.1920x1080",
              at_least=0.8, bound_by=(
                  *(f"worlds/depth.1920x1080.{part}." for part in ("stage", "cpu")),
                  "limits/depth_frame.")),
    Criterion("300,000 triangles, a picture", "worlds/frame.signs.300000", at_most=8),
    Criterion("300,000 triangles, a picture at work", "worlds/frame_at_work.signs.300000",
              at_most=8, bound_by=("worlds/signs.300000.stage.",)),
    *(Criterion(f"coarse environment against {name}, {size}, {processes} at once",
                f"learning/ratio.coarse.{kind}.{size}.{processes}", at_least=bound)
      for kind, name, bound in (("tiny", "TinyRenderer", 20), ("plugin", "EGL plugin", 3))
      for size in ("84x84", "320x240") for processes in (1, 2)),
)


def judge(figures: Mapping[str, Figure]) -> list[Verdict]:
    """Verdicts on what was measured; figures by PART/NAME."""
    return [
        Verdict(criterion, figures[criterion.figure], tuple(
            replace(one, name=name) for name, one in figures.items()
            if criterion.bound_by and name.startswith(criterion.bound_by)))
        for criterion in CRITERIA
        if criterion.figure in figures
    ]
