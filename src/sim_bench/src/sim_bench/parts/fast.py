"""How much faster than real time: with a camera in lockstep, and with no camera subscriber.

The first is a lap of `make course FAST=1 CAMERA=640x480` as it is; the second the same without
film and scoring: lesson 05, the world waiting for each command. The others have real_time_factor 0
and nobody who subscribes to a camera, with the waffle standing, when the world may rest and leave
the engine out, and driving a circle, when it cannot. The engine's bare step while driving is taken
right after: what the node adds to it is the difference.
"""

from __future__ import annotations

import time

from run_session import simulator
from run_session.processes import Child
from sim_bench.course_drive import (
    COMMANDS,
    Follower,
    camera_arguments,
    fast_arguments,
    launch_course,
)
from sim_bench.figures import Figure, figure
from sim_bench.marked_lap import marked_lap
from sim_bench.parts.step import bare_step_time
from sim_bench.ros_run import RosRun, ros_run
from sim_bench.settings import Settings
from sim_bench.stages import PROFILE, stage_figures, stages

SIZE = (640, 480)
WINDOWS, WINDOW = 5, 4.0  # s, wall
WARM_UP = 2.0  # s, wall
CIRCLE = "{linear: {x: 0.15}, angular: {z: 0.3}}"  # m/s, rad/s
STEP = 0.001  # s, of the course's world


def measure(settings: Settings) -> list[Figure]:
    """Real-time factors, and microseconds of a whole step of the node."""
    settings.say("a lap of `make course FAST=1 CAMERA=640x480`")
    report = marked_lap(settings, "make_course_fast", "--fast", "--camera", "{}x{}".format(*SIZE))
    found = [figure("make_course.real_time_factor", "x", [report["real_time_factor"]])]
    with ros_run(settings, "fast") as run:
        settings.say("lesson 05 in lockstep at 640x480")
        found += _lockstep(run, settings)
        settings.say("as fast as it goes, no camera subscriber")
        return found + _without_camera(run, settings)


def send_circle(run: RosRun) -> Child:
    """A command that stands: the waffle drives a circle of 0.5 m radius until the child ends."""
    return run.start("rostopic", ["rostopic", "pub", COMMANDS, "geometry_msgs/Twist", CIRCLE])


def _lockstep(run: RosRun, settings: Settings) -> list[Figure]:
    launched = launch_course(run, *camera_arguments(*SIZE), *fast_arguments(lockstep=True),
                             PROFILE)
    follower = Follower(run, SIZE[0])
    follower.wait_until_listening()
    simulator.unpause()
    follower.wait_until_driving()
    run.pause(WARM_UP)
    began, start = time.monotonic(), simulator.simulated_time()
    factors = _factors(run, settings)
    end, wall = simulator.simulated_time(), time.monotonic() - began
    frames = [stamp for _, stamp in follower.seen().frames if start < stamp <= end]
    run.end(follower.child)
    run.end(launched)
    return [
        figure("lockstep.real_time_factor", "x", factors),
        figure("lockstep.frames", "frames/s", [len(frames) / wall]),
        figure("lockstep.frames_a_simulated_s", "frames", [len(frames) / (end - start)]),
        *stage_figures("lockstep", stages(launched.log, turn="send")),
    ]


def _without_camera(run: RosRun, settings: Settings) -> list[Figure]:
    launched = launch_course(run, *fast_arguments(lockstep=False))
    simulator.unpause()
    found = _state(run, "standing", settings)
    circle = send_circle(run)
    found += _state(run, "driving", settings)
    run.end(circle)
    run.end(launched)
    bare = [1e6 * bare_step_time() for _ in range(settings.runs(WINDOWS))]
    return [*found, figure("no_camera.driving.bare_step", "us", bare)]


def _state(run: RosRun, state: str, settings: Settings) -> list[Figure]:
    run.pause(WARM_UP)
    factors = _factors(run, settings)
    steps = [1e6 * STEP / factor for factor in factors]
    return [
        figure(f"no_camera.{state}.real_time_factor", "x", factors),
        figure(f"no_camera.{state}.step", "us", steps),
    ]


def _factors(run: RosRun, settings: Settings) -> list[float]:
    """Real-time factor of each window."""
    factors = []
    for _ in range(settings.runs(WINDOWS)):
        began, start = time.monotonic(), simulator.simulated_time()
        run.pause(settings.seconds(WINDOW))
        passed = simulator.simulated_time() - start
        factors.append(passed / (time.monotonic() - began))
    return factors
