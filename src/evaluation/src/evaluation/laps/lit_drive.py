"""A drive by course_run in a world of its own light, as fast as it goes, in its own process."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from bullet_sim.formats.resources import Resources
from run_session.resources import find_package
from run_session.session import DriveProcess, Session
from trial_worlds.light import write_lit_world

MODEL_PATH = "GAZEBO_MODEL_PATH"


def write_world(world: Path, models: Path, light: float, folder: Path) -> Path:
    """`world` with its light times `light`, below the folder; `models` has the world's own.

    WorldError for a file that is no world.
    """
    sun = Resources.from_environment().resolve("model://sun")
    return write_lit_world(world, models, sun, light, folder)


def start(session: Session, arguments: list[str], folder: Path, models: list[Path]) -> DriveProcess:
    """course_run with these arguments; results go to the folder, its models are found first."""
    script = find_package("evaluation") / "scripts" / "course_run.py"
    path = ":".join(str(each) for each in [*models, os.environ.get(MODEL_PATH, "")] if str(each))
    command = [sys.executable, "-P", str(script), *arguments, "--out", str(folder)]
    return session.start_drive(command, folder, {**os.environ, MODEL_PATH: path})


def launch_arguments(world: Path, start_pose: tuple[float, float, float], noise: float,
                     answer_limit: float, *more: str) -> list[str]:
    """Options of course_run for the launch file; m, rad, s, noise as a standard deviation.

    `answer_limit`: for the follower's answer, so that a busy machine does not change a drive.
    """
    x, y, yaw = start_pose
    named = (f"world_name:={world}", f"x_pos:={x:.6f}", f"y_pos:={y:.6f}", f"yaw:={yaw:.6f}",
             f"camera_noise:={noise:.6f}", f"lockstep_timeout:={answer_limit:g}", *more)
    return [word for argument in named for word in ("--launch-arg", argument)]
