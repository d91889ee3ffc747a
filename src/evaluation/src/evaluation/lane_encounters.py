"""Judges from true poses how a car behaved towards each person who crossed in front of it.

An encounter: a person's body is between the lane's lines (in the lane) while the car approaches
that zebra crossing, its front at most APPROACH before it. Rules, each judged separately:
- touched: the car's outline and the person's body came nearer than TOUCHED. Never allowed, and
  checked over the whole drive, not only in encounters.
- stood off: while a person is in the lane and the car is before them, its front stays KEPT_OFF or
  more from the person's body, and a car that stops, stops KEPT_OFF or more before the zebra.
- moved on: at the latest MOVES_ON after the person left the lane, the car drives at GOES or more,
unless it never had to stop.
"""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from pathlib import Path

from lane_keeping.world.scenery import PERSON_RADIUS, Crossings, Zebra

from run_session.failure import RunError

CAR = "car"


@dataclass(frozen=True)
class Moment:
    """One true pose: simulated s, m, rad, m/s."""

    time: float
    x: float
    y: float
    yaw: float
    speed: float


# In order of time, by name: CAR, and people by their models' names.
Recording = dict[str, list[Moment]]


def last(moments: list[Moment], time: float) -> Moment | None:
    """The last of them up to this time; None: there is none."""
    index = bisect.bisect_right(moments, time, key=lambda moment: moment.time)
    return moments[index - 1] if index else None


def line_of(name: str, moment: Moment) -> str:
    """The file's line for one moment."""
    return (f"{name} {moment.time:.3f} {moment.x:.4f} {moment.y:.4f} {moment.yaw:.4f} "
            f"{moment.speed:.4f}\n")


def read_recording(path: Path) -> Recording:
    """Read what `line_of` wrote; an incomplete last line is ignored."""
    found: Recording = {}
    try:
        lines = path.read_text(encoding="utf-8").split("\n")[:-1]
        for line in lines:
            name, *numbers = line.split()
            moment = Moment(*map(float, numbers))
            if not all(map(math.isfinite, (moment.time, moment.x, moment.y))):
                raise ValueError(line)
            found.setdefault(name, []).append(moment)
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}") from error
    except (TypeError, ValueError) as error:
        raise RunError(f"{path}: no recording of a drive: {error}") from error
    for moments in found.values():
        moments.sort(key=lambda moment: moment.time)
    return found


CAR_FRONT, CAR_REAR, CAR_HALF_WIDTH = 0.20, 0.16, 0.15  # m from base_footprint, incl. wheels
APPROACH, KEPT_OFF, TOUCHED = 2.0, 0.3, 0.005  # m
MOVES_ON, GOES, STANDS = 2.0, 0.1, 0.05  # s, m/s, m/s


@dataclass(frozen=True)
class Encounter:
    """One person's walk through the lane in front of a car; m, s."""

    person: str
    zebra: int  # from 1
    entered: float  # simulated time at which the body reached the lane
    left: float  # simulated time at which it was out of the lane again
    nearest: float  # from the car's outline to the body
    stopped_before: float | None  # from front to zebra where the car stopped; None: it did not
    moved_after: float | None  # from `left` until the car drove; None: never, or it had not stopped
    must_move: bool  # whether it was stopped when the lane was clear

    @property
    def touched(self) -> bool:
        """Whether car and person touched."""
        return self.nearest < TOUCHED

    @property
    def stood_off(self) -> bool:
        """Whether the car kept its distance from person and zebra."""
        before = self.stopped_before
        return self.nearest >= KEPT_OFF and (before is None or before >= KEPT_OFF)

    @property
    def moved_on(self) -> bool:
        """Whether it drove on soon enough."""
        return not self.must_move or (self.moved_after is not None and self.moved_after <= MOVES_ON)

    @property
    def passed(self) -> bool:
        """Whether all rules were kept."""
        return not self.touched and self.stood_off and self.moved_on


def judge(recording: Recording, crossings: Crossings, lane_half: float) -> list[Encounter]:
    """All encounters of a drive, in order of time; `lane_half`: m from lane middle to line."""
    found = []
    for number, zebra in enumerate(crossings.zebras, start=1):
        person = f"pedestrian_{number}"
        for begin, end in _walks(recording.get(person, []), zebra, lane_half):
            encounter = _encounter(recording, crossings, number, (begin, end))
            if encounter is not None:
                found.append(encounter)
    return sorted(found, key=lambda encounter: encounter.entered)


def nearest_ever(recording: Recording) -> float:
    """Least distance (m) between the car's outline and any person, over the whole drive."""
    people = [moments for name, moments in recording.items() if name != CAR]
    gaps = [distance(car, there) for moments in people for car in recording.get(CAR, [])
            if (there := last(moments, car.time)) is not None
            and abs(there.x - car.x) + abs(there.y - car.y) < 2 * APPROACH]
    return min(gaps, default=math.inf)


def distance(car: Moment, person: Moment) -> float:
    """From the car's outline to a person's body, m; 0 where they meet."""
    along, left = _within(car.x, car.y, car.yaw, person)
    beyond = max(along - CAR_FRONT, -CAR_REAR - along, 0.0)
    return max(math.hypot(beyond, max(abs(left) - CAR_HALF_WIDTH, 0.0)) - PERSON_RADIUS, 0.0)


def _walks(moments: list[Moment], zebra: Zebra, lane_half: float) -> list[tuple[float, float]]:
    """The times at which a person's body entered and left the lane, one pair for each walk."""
    walks, entered = [], None
    for moment in moments:
        left = _within(zebra.x, zebra.y, zebra.heading, moment)[1]
        inside = abs(left) < lane_half + PERSON_RADIUS
        if inside and entered is None:
            entered = moment.time
        if not inside and entered is not None:
            walks.append((entered, moment.time))
            entered = None
    return walks


def _encounter(recording: Recording, crossings: Crossings, number: int,
               walk: tuple[float, float]) -> Encounter | None:
    zebra, person = crossings.zebras[number - 1], f"pedestrian_{number}"
    cars = [car for car in recording.get(CAR, []) if walk[0] <= car.time <= walk[1]]
    before = [(car, gap) for car in cars
              if (gap := _front_gap(car, zebra, crossings.length)) is not None]
    if not any(gap <= APPROACH for _, gap in before):
        return None
    pairs = [(car, last(recording[person], car.time)) for car in cars]
    nearest = min(distance(car, there) for car, there in pairs if there is not None)
    stood = [gap for car, gap in before if car.speed < STANDS and gap <= APPROACH]
    stands_at_end = before[-1][0].speed < GOES and before[-1][1] <= APPROACH
    after = _moves_after(recording[CAR], walk[1]) if stands_at_end else None
    return Encounter(person, number, walk[0], walk[1], nearest, min(stood, default=None), after,
                     stands_at_end)


def _front_gap(car: Moment, zebra: Zebra, length: float) -> float | None:
    """From the car's front to the zebra's near edge, m, negative on it; None: past or beside it."""
    along, left = _within(zebra.x, zebra.y, zebra.heading, car)
    if abs(left) > 1.0 or along - CAR_REAR > length / 2:
        return None
    return -length / 2 - (along + CAR_FRONT)


def _moves_after(cars: list[Moment], clear: float) -> float | None:
    return next((car.time - clear for car in cars if car.time >= clear and car.speed >= GOES), None)


def _within(x: float, y: float, yaw: float, other: Moment) -> tuple[float, float]:
    """The other's position ahead and to the left of a pose, m."""
    dx, dy = other.x - x, other.y - y
    return (math.cos(yaw) * dx + math.sin(yaw) * dy, math.cos(yaw) * dy - math.sin(yaw) * dx)
