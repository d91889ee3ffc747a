"""How much faster than real time: with a camera in lockstep, and with no camera subscriber.

The first is a lap of `make course FAST=1 CAMERA=640x480` as it is; the second the same without
film and scoring: lesson 05, the world waiting for each command. The others have real_time_factor 0
and nobody who subscribes to a camera, with the waffle standing, when the world may rest and leave
the engine out, and driving a circle, when it cannot. The engine's bare step while driving is taken
right after: what the node adds to it is the difference.
"""

from __future__ import annotations

from run_session import simulator
from sim_bench.figures import Figure, figure
from sim_bench.follower import FAST, LOCKSTEP, Follower, launch_course, send_circle
from sim_bench.parts.step import bare_step_time
from sim_bench.ros_run import PROFILE, RosRun, marked_lap, ros_run, stage_figures, stages
from sim_bench.settings import Settings, say

SIZE = (640, 480)
WINDOWS, WINDOW = 5, 4.0  # s, wall
WARM_UP = 2.0  # s, wall
STEP = 0.001  # s, of the course's world


def measure(settings: Settings) -> list[Figure]:
    """Real-time factors, and microseconds of a whole step of the node."""
    say("a lap of `make course FAST=1 CAMERA=640x480`")
    report = marked_lap(settings, "make_course_fast", "--fast", "--camera", "{}x{}".format(*SIZE))
    found = [figure("make_course.real_time_factor", "x", [report["real_time_factor"]])]
    with ros_run(settings, "fast") as run:
        say("lesson 05 in lockstep at 640x480")
        found += _lockstep(run)
        say("as fast as it goes, no camera subscriber")
        return found + _without_camera(run, settings)


def _lockstep(run: RosRun) -> list[Figure]:
    follower = Follower(run, SIZE, *LOCKSTEP, PROFILE)
    factors = [window.factor for window in run.windows(WINDOWS, WINDOW, WARM_UP)]
    follower.end()
    return [figure("lockstep.real_time_factor", "x", factors),
            *stage_figures("lockstep", stages(follower.launched.log, turn="send"))]


def _without_camera(run: RosRun, settings: Settings) -> list[Figure]:
    launched = launch_course(run, *FAST)
    simulator.unpause()
    found = _state(run, "standing")
    circle = send_circle(run)
    found += _state(run, "driving")
    run.stop(circle, launched)
    bare = [1e6 * bare_step_time() for _ in range(settings.runs(WINDOWS))]
    return [*found, figure("no_camera.driving.bare_step", "us", bare)]


def _state(run: RosRun, state: str) -> list[Figure]:
    factors = [window.factor for window in run.windows(WINDOWS, WINDOW, WARM_UP)]
    return [figure(f"no_camera.{state}.real_time_factor", "x", factors),
            figure(f"no_camera.{state}.step", "us", [1e6 * STEP / factor for factor in factors])]
