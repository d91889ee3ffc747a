"""The main job as `make course` runs it, film and scoring included, for the parts that time it."""

from __future__ import annotations

import json
import sys

import rospkg

from run_session.failure import RunError
from sim_bench.ros_run import ros_run
from sim_bench.settings import Settings

LIMIT = 600.0  # s, wall
QUICK_DURATION = 15.0  # s, simulated


def marked_lap(settings: Settings, name: str, *options: str) -> dict:
    """report.json of one lap with lesson 05; of 15 simulated seconds in a quick pass."""
    script = f"{rospkg.RosPack().get_path('evaluation')}/scripts/course_run.py"
    with ros_run(settings, name, roscore=False) as run:
        out = run.folder / "course"
        report = out / "report.json"
        report.unlink(missing_ok=True)
        short = ("--duration", str(QUICK_DURATION)) if settings.quick else ()
        child = run.start(
            "course_run", [sys.executable, "-P", script, "--out", str(out), *short, *options]
        )
        run.forget(child)  # it ends by itself
        run.wait(lambda: child.process.poll() is not None, LIMIT, "the end of the lap")
        if not report.exists():
            raise RunError("course_run.py wrote no report", child.last_lines())
        return json.loads(report.read_text(encoding="utf-8"))
