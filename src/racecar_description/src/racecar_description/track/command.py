"""make_track: reads the command line, writes a course's files, prints what to type next."""

from __future__ import annotations

import argparse
import math
import os
import re
import shlex
import sys
from pathlib import Path

import cv2

from racecar_description.track.circuit import LEAST_WIDTH, TURNING_CIRCLE, Circuit, road_width
from racecar_description.track.drawing import parse_colour
from racecar_description.track.errors import DrawingError, TrackError
from racecar_description.track.from_drawing import from_drawing
from racecar_description.track.from_numbers import from_seed, from_track_file
from racecar_description.track.model_files import (
    TAKEN_NAMES,
    WRITTEN_BY,
    model_folder,
    preview_path,
    world_path,
    write_course,
)
from racecar_description.track.preview import draw_problem
from racecar_description.track.wishes import Wishes

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
LARGEST = 100.0  # m, side of a plane

ABOUT = "Makes a track from a drawing, a centre line or a seed: model, world, map, centre line."
EXAMPLES = """examples of commands:
  make_track drawing.png --size 12x8 --walls      the road is dark in the picture
  make_track photo.jpg --road red --name monza    ... or red
  make_track tracks/monza.yaml --reverse          from a centre line, in the opposite direction
  make_track --random 7 --walls                   a random circuit, always the same for a seed
"""


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    result = argparse.ArgumentParser(
        prog="make_track", description=ABOUT, epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    add = result.add_argument
    add("source", nargs="?", type=Path, help="a picture (PNG, JPEG), or a track file (.yaml)")
    add("--random", type=_seed, metavar="SEED", help="a random circuit instead")
    add("--size", type=_size, metavar="WxH", help="m, of the painted plane (12x8)")
    add("--walls", action="store_true", help="low walls along both edges of the road")
    add("--width", type=_width, metavar="M", help="m, of the road (as drawn)")
    add("--road", type=_colour, metavar="COLOUR", help="red, '#1e90ff' ... (dark parts)")
    add("--reverse", action="store_true", help="opposite direction (counter-clockwise)")
    add("--start", type=_point, metavar="X,Y", help="m, where laps start, by the preview's rulers")
    add("--min-radius", type=_length, default=1.2, metavar="M", help="m, of random bends (1.2)")
    add("--name", help="of model, world and map (the file's)")
    add("--out", type=Path, metavar="DIR", help="where to write (the package racecar_description; "
        "out/tracks if that is installed)")
    return result


def main(words: list[str], package: Path) -> int:
    """Run the command; `package` is the folder of racecar_description. Returns the exit code."""
    try:
        try:
            return _make(words, package)
        finally:  # also after --help, which ends in SystemExit
            sys.stdout.flush()
    except BrokenPipeError:  # the reader closed the pipe, like `head`: the files are written
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the flush at exit
        return 0


def _make(words: list[str], package: Path) -> int:
    options = parser().parse_args(_signed_values(words))
    name = options.name or "track"
    out = options.out or (Path("out/tracks") if _is_installed(package) else package)
    try:
        name = _name(options)
        if name in TAKEN_NAMES:
            taken = ", ".join(TAKEN_NAMES)
            raise TrackError(f"{name!r} cannot be a track: the world takes {taken}; use --name")
        _check_free(out, name)
        course, remarks = _course(options, name)
        write_course(course, out)
    except DrawingError as error:
        return _fail(f"{error}{_write_problem(error, options.out or Path(), name)}")
    except TrackError as error:
        return _fail(str(error))
    except OSError as error:
        return _fail(f"{error.filename}: {error.strerror}; write elsewhere with --out DIR")
    print("\n".join(_summary(course, remarks, out, package)))
    return 0


def _is_installed(package: Path) -> bool:
    """Whether it is in an install space, where no tracks should be written."""
    return package.parent.name == "share" and (package.parent.parent / "setup.sh").exists()


def _course(options: argparse.Namespace, name: str) -> tuple[Circuit, list[str]]:
    wishes = Wishes(
        name=name, size=options.size, width=options.width, walls=options.walls,
        backwards=options.reverse, start=options.start, colour=options.road,
        least_radius=options.min_radius)
    if options.random is not None:
        return from_seed(options.random, wishes)
    if options.source.suffix.lower() in (".yaml", ".yml"):
        return from_track_file(options.source, wishes)
    return from_drawing(options.source, wishes)


def _name(options: argparse.Namespace) -> str:
    if (options.source is None) == (options.random is None):
        raise TrackError("give a picture, a track file or --random SEED (one of them)")
    if options.name is not None:
        if not NAME.fullmatch(options.name):
            raise TrackError(f"--name {options.name!r}: letters, digits and _, a letter first")
        return options.name
    if options.random is not None:
        return f"random_{options.random}"
    plain = re.sub(r"[^A-Za-z0-9_]+", "_", options.source.stem).strip("_")
    return plain if NAME.fullmatch(plain) else f"track_{plain}".rstrip("_")


def _check_free(out: Path, name: str) -> None:
    """TrackError if the name belongs to a course that this command has not made."""
    folder = out / model_folder(name)
    if not folder.exists() and not (out / world_path(name)).exists():
        return
    config = folder / "model.config"
    if not config.is_file() or WRITTEN_BY.encode() not in config.read_bytes():
        raise TrackError(f"{name!r} is taken by {folder}, which is not this command's; use --name")


def _write_problem(error: DrawingError, folder: Path, name: str) -> str:
    """Write the marked picture; returns a message about it."""
    path = folder / f"{name}_problem.png"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        path.write_bytes(cv2.imencode(".png", draw_problem(error))[1].tobytes())
    except OSError as failure:
        return f" (no marked picture: {path}: {failure.strerror})"
    return f" (marked in {path})"


def _summary(course: Circuit, remarks: list[str], out: Path, package: Path) -> list[str]:
    radius, x, y = course.line.tightest()
    road = road_width(course.lane_width)
    lines = [
        f"{course.name}: a lap of {course.line.length:.2f} m, road {road:.2f} m wide,"
        f" tightest bend {radius:.2f} m"
    ]
    lines += [f"note: {remark}" for remark in remarks]
    if radius < TURNING_CIRCLE:
        ruler = (x + course.origin[0], y + course.origin[1])
        lines.append(
            f"warning: the bend at {ruler[0]:.1f}, {ruler[1]:.1f} (rulers of the preview) has a"
            f" radius of {radius:.2f} m; the racecar needs {TURNING_CIRCLE} m: draw it wider, or"
            " make --size larger"
        )
    lines += [f"preview: {(out / preview_path(course.name)).resolve()}", "next:"]
    return [*lines, f"  {_next_command(course, out, package)}"]


def _next_command(course: Circuit, out: Path, package: Path) -> str:
    """The command that starts the car in this world, in a sourced workspace."""
    world = shlex.quote(str((out / world_path(course.name)).resolve()))
    x, y, heading = (f"{value:.6g}" for value in course.start)
    command = "roslaunch racecar_description car_control.launch"
    command += f" world_name:={world} x_pos:={x} y_pos:={y} yaw:={heading}"
    if out.resolve() == package.resolve():
        return command
    models = shlex.quote(str((out / "models").resolve()))
    return f"GAZEBO_MODEL_PATH={models}:$GAZEBO_MODEL_PATH {command}"


def _fail(text: str) -> int:
    print(f"make_track: {text}", file=sys.stderr)
    return 1


def _signed_values(words: list[str]) -> list[str]:
    """Turn `--start -1,2` into `--start=-1,2`: argparse takes a leading minus for an option."""
    result: list[str] = []
    for word in words:
        if result and result[-1] == "--start":
            result[-1] += f"={word}"
        else:
            result.append(word)
    return result


def _length(text: str) -> float:
    value = float(text) if re.fullmatch(r"[0-9.]+", text) and text.count(".") < 2 else math.nan
    if not 0 < value <= LARGEST:
        raise argparse.ArgumentTypeError(f"{text!r} must be metres, above 0, up to {LARGEST:g}")
    return value


def _width(text: str) -> float:
    value = _length(text)
    if value < LEAST_WIDTH:
        raise argparse.ArgumentTypeError(f"{value:g} m is too narrow; {LEAST_WIDTH} m at least")
    return value


def _size(text: str) -> tuple[float, float]:
    sides = text.lower().replace("*", "x").split("x")
    if len(sides) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} must be two lengths in metres, such as 12x8")
    return _length(sides[0]), _length(sides[1])


def _point(text: str) -> tuple[float, float]:
    try:
        x, y = (float(value) for value in text.split(","))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise argparse.ArgumentTypeError(f"{text!r} must be two numbers in metres, such as 3.5,1")
    return x, y


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 0")
    return int(text)


def _colour(text: str) -> str:
    try:
        parse_colour(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return text
