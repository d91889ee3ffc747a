"""How much faster than real time: with a camera in lockstep, and with no camera subscriber.

The first is a lap of `make course FAST=1 CAMERA=640x480` as it is; the second the same without
film and scoring: lesson 05, the world waiting for each command. The others have real_time_factor 0
and nobody who subscribes to a camera, with the waffle standing, when the world may rest and leave
the engine out, and driving a circle, when it cannot. A `limit` is what were reached if nothing but
the engine's bare steps, and what OpenGL takes for lockstep's pictures, took time.
"""

from __future__ import annotations

from run_session import simulator
from sim_bench.figures import Figure, figure
from sim_bench.follower import FAST, LOCKSTEP, Follower, launch_course, send_circle
from sim_bench.parts.step import STEP, bare_step_time
from sim_bench.ros_run import PROFILE, RosRun, marked_lap, ros_run, stage_figures, stages
from sim_bench.settings import Settings, say

SIZE = (640, 480)
WINDOWS, WINDOW = 5, 4.0  # s, wall
WARM_UP = 2.0  # s, wall
FRAME = 1 / 30  # s, simulated, between two of the camera's pictures


def measure(settings: Settings) -> list[Figure]:
    """Real-time factors, and microseconds of a whole step of the node."""
    say("a lap of `make course FAST=1 CAMERA=640x480`")
    report = marked_lap(settings, "make_course_fast", "--fast", "--camera", "{}x{}".format(*SIZE))
    bare = [bare_step_time() for _ in range(settings.runs(WINDOWS))]
    found = [figure("make_course.real_time_factor", "x", [report["real_time_factor"]]),
             figure("no_camera.driving.bare_step", "us", [1e6 * one for one in bare]),
             figure("no_camera.driving.limit", "x", [STEP / one for one in bare])]
    with ros_run(settings, "fast") as run:
        say("lesson 05 in lockstep at 640x480")
        found += _lockstep(run, min(bare))
        say("as fast as it goes, no camera subscriber")
        return found + _without_camera(run)


def _lockstep(run: RosRun, bare: float) -> list[Figure]:
    """`bare`: s of an engine's step."""
    follower = Follower(run, SIZE, *LOCKSTEP, PROFILE)
    factors = [window.factor for window in run.windows(WINDOWS, WINDOW, WARM_UP)]
    follower.end()
    work = stages(follower.launched.log, turn="send")
    limit = FRAME / (FRAME / STEP * bare + work["draw"] / 1e3)
    return [figure("lockstep.real_time_factor", "x", factors),
            figure("lockstep.limit", "x", [limit]), *stage_figures("lockstep", work)]


def _without_camera(run: RosRun) -> list[Figure]:
    launched = launch_course(run, *FAST)
    simulator.unpause()
    found = _state(run, "standing")
    circle = send_circle(run)
    found += _state(run, "driving")
    run.stop(circle, launched)
    return found


def _state(run: RosRun, state: str) -> list[Figure]:
    factors = [window.factor for window in run.windows(WINDOWS, WINDOW, WARM_UP)]
    return [figure(f"no_camera.{state}.real_time_factor", "x", factors),
            figure(f"no_camera.{state}.step", "us", [1e6 * STEP / factor for factor in factors])]
