"""Laps: how one is disturbed, and how a drive along a track is scored."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from racecar_description.track.closed_line import Track


@dataclass(frozen=True)
class Disturbance:
    """The disturbance of one lap."""

    sideways: float  # m beside the line, positive to the left
    along: float  # m along the line, from the start of laps
    turn: float  # rad from the line's direction, positive to the left
    camera_noise: float  # standard deviation; 1 is full brightness
    light: float  # factor on the world's own light

    def start(self, track: Track) -> tuple[float, float, float]:
        """The car's start pose: x, y (m) and yaw (rad) in the world."""
        x, y, heading = track.pose(self.along)
        x -= self.sideways * math.sin(heading)
        y += self.sideways * math.cos(heading)
        return x, y, heading + self.turn


@dataclass(frozen=True)
class Bounds:
    """Bounds of random disturbances: m and rad to either side; other units as in Disturbance."""

    sideways: float
    along: float
    turn: float
    camera_noise: tuple[float, float]
    light: tuple[float, float]


# For race-trials, and for learning environments that use the trials' disturbances.
RACE = Bounds(sideways=0.2, along=0.2, turn=math.radians(10), camera_noise=(0.01, 0.03),
              light=(0.7, 1.3))


def draw(seed: int, bounds: Bounds) -> Disturbance:
    """The seed's disturbance, uniformly distributed between the bounds."""
    random = np.random.default_rng(seed)
    return Disturbance(
        sideways=random.uniform(-bounds.sideways, bounds.sideways),
        along=random.uniform(-bounds.along, bounds.along) if bounds.along else 0.0,
        turn=random.uniform(-bounds.turn, bounds.turn),
        camera_noise=random.uniform(*bounds.camera_noise),
        light=random.uniform(*bounds.light),
    )


STALL_TIME, STALL_DISTANCE = 5.0, 0.02  # s and m: less progress than this in that time is a stall
START_TIME = 30.0  # s that a follower may take until the car first moves
MOVED = 0.005  # m from its start beyond which the car counts as moving
REVERSED = 0.3  # m driven against the course's direction: ends the drive
LAP_SHARE = 0.8  # share of the line to drive before crossing its start completes a lap


@dataclass(frozen=True)
class Sample:
    """The car's true pose: simulated time, s, and base_footprint in the world, m and rad."""

    time: float
    x: float
    y: float
    yaw: float


class Verdict(Enum):
    """State of a drive; all but DRIVING end it."""

    DRIVING = "driving"
    CLOSED = "closed"
    LEFT = "left the course"
    STALLED = "stalled"
    REVERSED = "drove the wrong way"
    LATE = "time is up"


@dataclass(frozen=True)
class Lap:
    """One completed lap: s, m, and lateral errors in m."""

    time: float
    distance: float
    rms_lateral: float
    max_lateral: float


@dataclass
class _Tally:
    """Sums over a lap, or over the whole drive."""

    distance: float = 0.0
    squares: float = 0.0  # m² s
    time: float = 0.0
    max_lateral: float = 0.0

    def add(self, step: float, lateral: float, seconds: float) -> None:
        self.distance += step
        self.squares += lateral * lateral * seconds
        self.time += seconds
        self.max_lateral = max(self.max_lateral, abs(lateral))

    @property
    def rms_lateral(self) -> float:
        return math.sqrt(self.squares / self.time) if self.time > 0 else 0.0


@dataclass
class LapScorer:
    """Takes samples in order of time; the verdict is final once it is not DRIVING."""

    track: Track
    wanted_laps: int = 1
    off_course: float = 0.25  # m beside the line: farther than this and the car has left the course
    longest: float = math.inf  # s, simulated, of the whole drive
    verdict: Verdict = Verdict.DRIVING
    why: str = ""  # one line that explains a verdict other than CLOSED
    laps: list[Lap] = field(default_factory=list)
    samples: list[Sample] = field(default_factory=list)
    lap_numbers: list[int] = field(default_factory=list)  # of each sample, from 0
    laterals: list[float] = field(default_factory=list)  # m, of each sample
    lateral: float = 0.0  # m, of the latest sample; positive to the left of the line
    total: _Tally = field(default_factory=_Tally)
    _lap: _Tally = field(default_factory=_Tally)
    _lap_start: float = 0.0  # s
    _lap_from: float = 0.0  # m, position at which this lap began
    _position: float = 0.0  # m along the line, accumulated over laps
    _first_position: float = 0.0
    _farthest: float = 0.0
    _mark: tuple[float, float] = (0.0, 0.0)  # time and position of the last progress
    _moving: bool = False

    @property
    def over(self) -> bool:
        """Whether the drive has ended: further samples do not count."""
        return self.verdict is not Verdict.DRIVING

    @property
    def driven_share(self) -> float:
        """Driven share of the current lap, 0 to 1."""
        return min(max((self._position - self._lap_from) / self.track.length, 0.0), 1.0)

    @property
    def present_lap(self) -> int:
        """Number of the current lap, from 1."""
        return min(len(self.laps) + 1, self.wanted_laps)

    @property
    def progress(self) -> float:
        """m along the line since the first sample; negative backwards."""
        return self._position - self._first_position

    @property
    def last_progress(self) -> float:
        """s, when the car last came further along the line."""
        return self._mark[0]

    def add(self, sample: Sample) -> Verdict:
        """Score one more sample."""
        nearest = self.track.nearest(sample.x, sample.y)
        self.lateral = nearest.lateral
        if not self.samples:
            self._begin(sample, nearest.s)
        elif sample.time > self.samples[-1].time and self.verdict is Verdict.DRIVING:
            self._advance(sample, nearest.s)
        else:
            return self.verdict
        self.samples.append(sample)
        self.lap_numbers.append(len(self.laps))
        self.laterals.append(nearest.lateral)
        return self.verdict

    def _begin(self, sample: Sample, s: float) -> None:
        self._position = math.remainder(s, self.track.length)
        self._lap_from = self._farthest = self._first_position = self._position
        self._mark = (sample.time, self._position)
        self._lap_start = sample.time

    def _advance(self, sample: Sample, s: float) -> None:
        before, last = self._position, self.samples[-1]
        self._position += math.remainder(s - before, self.track.length)
        self._farthest = max(self._farthest, self._position)
        if not self._moving:
            first = self.samples[0]
            self._moving = math.hypot(sample.x - first.x, sample.y - first.y) > MOVED
            self._lap_start = last.time
            if self._moving:
                self._mark = (sample.time, self._position)
        if self._moving:
            step = math.hypot(sample.x - last.x, sample.y - last.y)
            for tally in (self.total, self._lap):
                tally.add(step, self.lateral, sample.time - last.time)
            self._cross_start(before, last.time, sample.time)
        self._judge(sample)

    def _cross_start(self, before: float, before_time: float, now: float) -> None:
        """Complete a lap, or begin the first one, if the start of the line was crossed."""
        length = self.track.length
        line = math.floor(self._position / length) * length
        if not before < line <= self._position:
            return
        passed = before_time + (now - before_time) * (line - before) / (self._position - before)
        if line - self._lap_from > LAP_SHARE * length:
            lap = self._lap
            seconds = passed - self._lap_start
            self.laps.append(Lap(seconds, lap.distance, lap.rms_lateral, lap.max_lateral))
        self._lap, self._lap_start, self._lap_from = _Tally(), passed, line

    def _judge(self, sample: Sample) -> None:
        where = f"at x={sample.x:.2f}, y={sample.y:.2f}, simulated time {sample.time:.1f} s"
        if abs(self._position - self._mark[1]) > STALL_DISTANCE:
            self._mark = (sample.time, self._position)
        waited = sample.time - self._mark[0]
        if abs(self.lateral) > self.off_course:
            beside = (f"{self.lateral:.2f} m to the left of the line" if self.lateral > 0 else
                      f"{-self.lateral:.2f} m to the right of the line")
            self._end(Verdict.LEFT, f"the car left the course {where}: {beside}")
        elif self._farthest - self._position > REVERSED:
            self._end(Verdict.REVERSED, f"the car drove the wrong way {where}")
        elif not self._moving and waited > START_TIME:
            self._end(Verdict.STALLED, f"the car stalled {where}: it never moved in {waited:.0f} s")
        elif self._moving and waited > STALL_TIME:
            little = f"less than {STALL_DISTANCE} m of progress in {STALL_TIME:.0f} s"
            self._end(Verdict.STALLED, f"the car stalled {where}: {little}")
        elif len(self.laps) >= self.wanted_laps:
            self._end(Verdict.CLOSED, "")
        elif sample.time - self.samples[0].time > self.longest:
            share = f"lap {len(self.laps) + 1} was {self.driven_share:.0%} driven"
            self._end(Verdict.LATE, f"{self.longest:g} simulated s are over: {share}")

    def _end(self, verdict: Verdict, why: str) -> None:
        self.verdict, self.why = verdict, why


def fingerprint(drive: LapScorer) -> str:
    """SHA-256 over times and poses of all samples, to compare drives bit for bit."""
    rows = [(sample.time, sample.x, sample.y, sample.yaw) for sample in drive.samples]
    return hashlib.sha256(np.array(rows, "<f8").tobytes()).hexdigest()
