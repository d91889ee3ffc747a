"""What is asked for in an episode, and where: a world, the line in it, reward and end.

Reward and end are as evaluation's trials score a drive; random worlds are made from a seed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Protocol

import numpy as np
import yaml
from ai_robot_tracking.scenes.scene import draw_scene, draw_start
from ai_robot_tracking.scenes.world_file import world_text
from racecar_description.track.closed_line import Track, build_track, load_track
from racecar_description.track.course_model import floor_files
from racecar_description.track.from_numbers import from_seed
from racecar_description.track.model_files import world_path, write_course
from racecar_description.track.painted_plane import write_files
from racecar_description.track.random_circuit import Room, random_circuit
from racecar_description.track.track_file import load_track_file
from racecar_description.track.wishes import Wishes

from bullet_sim.description import WorldDescription
from bullet_sim.formats.loading import load_world
from driving_courses.course import CourseSpec
from driving_courses.errors import CourseError
from driving_courses.packages import find_file
from driving_courses.randomisation import Episode
from driving_courses.resources import resources
from evaluation import track_score
from evaluation.lap import LapScorer, Sample, Verdict
from evaluation.track_score import TrackScorer

LEAST_RADIUS = 0.6  # m, of a random line's bends: as the line course's own
VERGE = 0.05  # m between a lane and its next stretch
FAILED = -1.0  # reward for leaving the course, stalling or driving the wrong way

Start = tuple[float, float, float]  # x, y (m), yaw (rad)


@dataclass(frozen=True)
class Venue:
    """A world without the robot, and the closed line to drive."""

    world: WorldDescription
    track: Track


class Venues:
    """A course's own venue, and random ones; each is made once."""

    def __init__(self, course: CourseSpec):
        self._course = course
        self._made: dict[int | None, Venue] = {}
        self._folder: TemporaryDirectory | None = None

    def get(self, seed: int | None) -> Venue:
        """The random one of that seed, or the course's own.

        CourseError for a course that has no random tracks.
        """
        if seed not in self._made:
            self._made[seed] = self._own() if seed is None else self._random(seed)
        return self._made[seed]

    def _own(self) -> Venue:
        course = self._course
        world = load_world(find_file(course.world), resources(course))
        return Venue(world, load_track(course.track_file))

    def _random(self, seed: int) -> Venue:
        if self._folder is None:
            self._folder = TemporaryDirectory(prefix="driving_courses-")
        folder = Path(self._folder.name) / str(seed)
        if self._course.random_track == "line":
            return self._random_line(seed, folder)
        if self._course.random_track == "race":
            return self._random_race(seed, folder)
        raise CourseError("randomise: tracks: this course has no random ones")

    def _random_line(self, seed: int, folder: Path) -> Venue:
        """The line course's plane, painted with another line; it too is driven clockwise."""
        own = load_track_file(self._course.track_file)
        line = random_circuit(seed, Room(own.size, own.size, own.lane_width + VERGE, LEAST_RADIUS))
        line = line.moved(-own.size / 2, -own.size / 2).reversed()
        longest = max(line.pieces, key=lambda piece: piece.length * piece.is_straight)
        start = longest.pose(longest.length / 2)[:2]
        track_file = replace(own, corners=line.corners, start=start)
        write_files(floor_files(track_file), folder / "turtlebot3_autorace" / "course")
        world = load_world(find_file(self._course.world), resources(self._course, (folder,)))
        return Venue(world, build_track(track_file))

    def _random_race(self, seed: int, folder: Path) -> Venue:
        """As the race's trials make them."""
        course, _ = from_seed(seed, Wishes(name=f"random_{seed}"))
        write_course(course, folder)
        found = resources(self._course, (folder / "models",))
        return Venue(load_world(folder / world_path(course.name), found),
                     build_track(course.track_file()))


class Task(Protocol):
    """One episode after the other."""

    def begin(self, episode: Episode) -> tuple[WorldDescription, Start]:
        """A new episode: its world, and where the robot starts."""

    def score(self, sample: Sample) -> tuple[float, bool]:
        """Reward for the way since the last sample, and whether the episode has ended."""

    def report(self) -> dict[str, Any]:
        """The drive's result so far, with the keys of the trials' report.json."""


class LapTask:
    """Laps along a line: a metre of progress is worth 1 on the line, nothing at the course's edge.

    A drive ends as `make course` ends it: laps closed, off the course, stalled, the wrong way.
    """

    def __init__(self, course: CourseSpec, laps: int):
        self._venues, self._off_course, self._laps = Venues(course), course.off_course, laps

    def begin(self, episode: Episode) -> tuple[WorldDescription, Start]:
        """See Task."""
        venue = self._venues.get(episode.track)
        self._drive = LapScorer(venue.track, self._laps, self._off_course)
        self._progress = 0.0
        return venue.world, episode.start.start(venue.track)

    def score(self, sample: Sample) -> tuple[float, bool]:
        """See Task."""
        drive = self._drive
        verdict = drive.add(sample)
        way, self._progress = drive.progress - self._progress, drive.progress
        reward = way * max(0.0, 1 - abs(drive.lateral) / drive.off_course)
        failed = verdict not in (Verdict.DRIVING, Verdict.CLOSED)
        return reward + FAILED * failed, verdict is not Verdict.DRIVING

    def report(self) -> dict[str, Any]:
        """See Task."""
        drive = self._drive
        return {
            "outcome": drive.verdict.value, "why": drive.why, "progress_m": drive.progress,
            "lateral_m": drive.lateral, "lap_times_s": [lap.time for lap in drive.laps],
            "distance_m": drive.total.distance, "rms_lateral_m": drive.total.rms_lateral,
            "max_lateral_m": drive.total.max_lateral,
        }


class FollowTask:
    """Keeping a distance to what walks: each second is worth 1 at that distance, 0 at the edge of
    the band that still counts as kept, -1 at worst. It ends as `make track` ends it, and where the
    distance was not kept."""

    def __init__(self, course: CourseSpec):
        self._course = course
        settings = find_file("ai_robot_tracking/config/tracking_params.yaml")
        self._wanted = float(yaml.safe_load(settings.read_text(encoding="utf-8"))[
            "visual_tracker_pid"]["wanted_distance"])

    def begin(self, episode: Episode) -> tuple[WorldDescription, Start]:
        """See Task."""
        seed = episode.track or 0
        scene = draw_scene(self._course.course, seed)
        self._drive = TrackScorer(track_score.Task(scene.way, scene.hidden, self._wanted))
        self._time = 0.0
        with TemporaryDirectory(prefix="driving_courses-") as folder:
            path = Path(folder) / "scene.world"
            path.write_text(world_text(scene), encoding="utf-8")
            world = load_world(path, resources(self._course))
        start, said = draw_start(self._course.course, seed), episode.start
        cos, sin = math.cos(start.yaw), math.sin(start.yaw)
        return world, (start.x + said.along * cos - said.sideways * sin,
                       start.y + said.along * sin + said.sideways * cos, start.yaw + said.turn)

    def score(self, sample: Sample) -> tuple[float, bool]:
        """See Task."""
        drive = self._drive
        drive.add(sample)
        elapsed, self._time = drive.elapsed - self._time, drive.elapsed
        lost = drive.left_at is not None
        reward = elapsed * max(-1.0, 1 - abs(drive.errors[-1]) / track_score.BAND)
        return reward + FAILED * (lost or (drive.over and not drive.good)), lost or drive.over

    def report(self) -> dict[str, Any]:
        """See Task."""
        drive, errors = self._drive, self._drive.judged_errors()
        over = drive.over or drive.left_at is not None
        return {
            "outcome": drive.outcome if over else "driving", "error_m": drive.errors[-1],
            "approach_s": drive.approach, "distance_m": drive.distance,
            "least_gap_m": drive.least_gap,
            "rms_error_m": float(np.sqrt(np.mean(errors ** 2))) if errors.size else None,
        }


def open_task(course: CourseSpec, laps: int) -> Task:
    """What the course's file says."""
    return LapTask(course, laps) if course.task == "lap" else FollowTask(course)
