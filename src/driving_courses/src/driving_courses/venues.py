"""Where laps are driven: a world, and the line in it; random ones are made from a seed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from racecar_description.track.closed_line import Track, build_track, load_track
from racecar_description.track.course_model import write_model
from racecar_description.track.from_numbers import from_seed
from racecar_description.track.model_files import world_path, write_course
from racecar_description.track.random_circuit import Room, random_circuit
from racecar_description.track.track_file import load_track_file
from racecar_description.track.wishes import Wishes

from bullet_sim.description import WorldDescription
from bullet_sim.formats.loading import load_world
from driving_courses.course import CourseSpec
from driving_courses.errors import CourseError
from driving_courses.packages import find_file
from driving_courses.resources import resources

LEAST_RADIUS = 0.6  # m, of a random line's bends: as the line course's own
VERGE = 0.05  # m between a lane and its next stretch


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
        write_model(track_file, folder / "turtlebot3_autorace" / "course")
        world = load_world(find_file(self._course.world), resources(self._course, (folder,)))
        return Venue(world, build_track(track_file))

    def _random_race(self, seed: int, folder: Path) -> Venue:
        """As the race's trials make them."""
        course, _ = from_seed(seed, Wishes(name=f"random_{seed}"))
        write_course(course, folder)
        found = resources(self._course, (folder / "models",))
        return Venue(load_world(folder / world_path(course.name), found),
                     build_track(course.track_file()))
