"""What is asked for in an episode: reward and end as evaluation's trials score a drive."""

from __future__ import annotations

from typing import Any, Protocol

from bullet_sim.description import WorldDescription
from driving_courses.course import Course
from driving_courses.randomisation import Episode
from driving_courses.venues import Venues
from evaluation.lap import LapScorer, Sample, Verdict

FAILED = -1.0  # reward for leaving the course, stalling or driving the wrong way

Start = tuple[float, float, float]  # x, y (m), yaw (rad)


class Task(Protocol):
    """One episode after the other."""

    def begin(self, episode: Episode) -> tuple[WorldDescription, Start]:
        """A new episode: its world, and where the robot starts."""

    def score(self, sample: Sample) -> tuple[float, bool]:
        """Reward for the way since the last sample, and whether the episode has ended."""

    def report(self) -> dict[str, Any]:
        """How the drive stands, in the words of the trials' report.json."""


class LapTask:
    """Laps along a line: a metre of progress is worth 1 on the line, nothing at the course's edge.

    A drive ends as `make course` ends it: laps closed, off the course, stalled, the wrong way.
    """

    def __init__(self, course: Course, laps: int):
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


def open_task(course: Course, laps: int) -> Task:
    """What the course's file says."""
    return LapTask(course, laps)
