"""make_track as a person types it: its files, what it says, and what it leaves alone."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import cv2
import drawn_tracks as drawn
import numpy as np
import pytest
import yaml
from racecar_description.track.centre_line import CentreLine
from racecar_description.track.circuit import road_width
from racecar_description.track.clearance import touching_place
from racecar_description.track.closed_line import load_track
from racecar_description.track.command import main
from racecar_description.track.from_numbers import from_seed
from racecar_description.track.track_file import load_track_file
from racecar_description.track.wishes import Wishes

from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.world import World

PACKAGE = Path(__file__).resolve().parent.parent
RACETRACK = PACKAGE / "tracks" / "racetrack.yaml"


@pytest.fixture
def make_track(tmp_path, monkeypatch, capsys):
    """make_track(words...) -> exit code, output, error output; in a folder of its own."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        code = main([str(word) for word in words], tmp_path / "package")
        return code, *capsys.readouterr()

    return run


def files_below(folder):
    """Relative path -> bytes."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*")) if path.is_file()
    }


def test_a_drawing_becomes_a_world_that_can_be_driven_in(make_track, tmp_path):
    cv2.imwrite("my track.png", drawn.bean())
    code, output, _ = make_track("my track.png", "--size", "12x8", "--walls")
    assert code == 0
    made = tmp_path / "package"
    assert set(files_below(made)) == {
        "models/my_track/model.config", "models/my_track/model.sdf",
        "models/my_track/materials/scripts/my_track.material",
        "models/my_track/materials/textures/my_track.png",
        "worlds/my_track.world", "tracks/my_track.yaml", "tracks/my_track.png",
        "maps/my_track.pgm", "maps/my_track.yaml"}
    world = made / "worlds" / "my_track.world"
    assert output.splitlines()[-1].strip() == (
        "roslaunch racecar_description car_control.launch"
        f" world_name:={world} x_pos:=0 y_pos:=0 yaw:=0"
    )
    assert load_track(made / "tracks/my_track.yaml").length == pytest.approx(22.7, abs=0.2)
    environment = {**os.environ, "GAZEBO_MODEL_PATH": str(made / "models")}
    simulated = World(load_world(world, Resources.from_environment(environment)))
    simulated.step(10)
    along = [(0.0, 0.0, 0.1), (0.0, 0.0, 0.1)]
    hits = simulated.cast_rays(np.array(along), np.array([(0.0, 5, 0.1), (0.0, -5, 0.1)]))
    half = load_track_file(made / "tracks/my_track.yaml").lane_width + 0.045
    assert 5 * hits.fraction == pytest.approx(half + 0.1, abs=0.06)
    simulated.close()


def test_the_map_is_free_on_the_road_and_has_the_walls(make_track, tmp_path):
    assert make_track(RACETRACK, "--name", "walled", "--walls")[0] == 0
    made = tmp_path / "package"
    facts = yaml.safe_load((made / "maps/walled.yaml").read_text())
    image = cv2.imread(str(made / "maps" / facts["image"]), cv2.IMREAD_UNCHANGED)
    track = load_track_file(made / "tracks/walled.yaml")

    def value(x, y):
        column, row = ((v - o) / facts["resolution"] for v, o in zip((x, y), facts["origin"]))
        return image[image.shape[0] - 1 - int(row), int(column)]

    line, wall = CentreLine(track.corners), road_width(track.lane_width) / 2 + 0.14
    for s in np.arange(0, line.length, 0.5):
        x, y, heading = line.pose(s)
        assert value(x, y) == 254
        for side in (-wall, wall):
            beside = (x - side * np.sin(heading), y + side * np.cos(heading))
            near = [value(beside[0] + i, beside[1] + j) for i in (-0.05, 0, 0.05)
                    for j in (-0.05, 0, 0.05)]
            assert 0 in near
    assert value(0.0, 3.9) == 205


def test_a_track_file_comes_back_as_it_was(make_track, tmp_path):
    assert make_track(RACETRACK, "--name", "again")[0] == 0
    first, again = load_track_file(RACETRACK), load_track_file(
        tmp_path / "package/tracks/again.yaml")
    assert (again.corners, again.start) == (first.corners, first.start)
    assert (again.line_width, again.lane_width) == (first.line_width, first.lane_width)
    assert make_track(tmp_path / "package/tracks/again.yaml", "--reverse", "--name", "back")[0] == 0
    back = load_track_file(tmp_path / "package/tracks/back.yaml")
    assert back.corners == first.corners[::-1]


def test_a_track_files_texture_lies_where_its_line_is(make_track, tmp_path):
    """Yellow at the line, white at the edges, asphalt between, in the world's coordinates."""
    assert make_track(RACETRACK, "--size", "12x8", "--name", "painted")[0] == 0
    folder = tmp_path / "package/models/painted/materials/textures"
    image = cv2.imread(str(folder / "painted.png")).astype(int)
    world = (tmp_path / "package/worlds/painted.world").read_text()
    x0, y0 = map(float, world.split("painted</uri>")[1].split("<pose>")[1].split()[:2])
    line = CentreLine(load_track_file(RACETRACK).corners)
    scale = image.shape[1] / 12.0
    for s in np.arange(1.0, line.length, 0.7):
        x, y, heading = line.pose(s)
        if np.hypot(x, y) < 0.5:
            continue  # the start line's squares
        for beside, bgr in ((0.0, (20, 205, 250)), (0.4, (235,) * 3), (0.2, (56, 53, 52))):
            place = (x - beside * np.sin(heading) - x0 + 6, y0 + 4 - y - beside * np.cos(heading))
            column, row = (int(v * scale) for v in place)
            assert np.abs(image[row, column] - bgr).max() < 12, (s, beside)


@pytest.mark.parametrize("seed", range(0, 31, 3))
def test_random_circuits_keep_their_promises(seed):
    course, _ = from_seed(seed, Wishes("random"))
    line = course.line
    assert line.tightest()[0] >= 1.2
    assert touching_place(line, 2 * course.half_road) is None
    points = line.points() + course.origin
    assert (points.min(axis=0) >= course.half_road).all()
    assert (points.max(axis=0) <= np.array((12, 8)) - course.half_road).all()
    turns = sum(piece.length * piece.curvature for piece in line.pieces)
    assert turns == pytest.approx(2 * np.pi)
    assert course.start[:2] == pytest.approx((0, 0), abs=1e-6)


def test_one_seed_gives_the_same_bytes_and_another_gives_others(make_track, tmp_path):
    for folder, seed in (("a", 4), ("b", 4), ("c", 5)):
        words = ("--random", seed, "--walls", "--name", "same", "--out", tmp_path / folder)
        assert make_track(*words)[0] == 0
    a, b, c = (files_below(tmp_path / folder) for folder in "abc")
    assert a == b
    assert a["tracks/same.yaml"] != c["tracks/same.yaml"]


def test_an_installed_package_is_left_alone(tmp_path, monkeypatch, capsys):
    package = tmp_path / "courses" / "share" / "racecar_description"
    package.mkdir(parents=True)
    (tmp_path / "courses" / "setup.sh").touch()
    (tmp_path / "home").mkdir()
    monkeypatch.chdir(tmp_path / "home")
    assert main(["--random", "7"], package) == 0
    assert not list(package.iterdir())
    assert (tmp_path / "home/out/tracks/worlds/random_7.world").is_file()
    assert "GAZEBO_MODEL_PATH=" in capsys.readouterr().out


def test_other_folders_are_told_to_gazebo(make_track, tmp_path):
    code, output, _ = make_track("--random", 1, "--out", tmp_path / "else where")
    assert code == 0
    assert output.splitlines()[-1].strip().startswith(
        f"GAZEBO_MODEL_PATH='{tmp_path / 'else where'}/models':$GAZEBO_MODEL_PATH roslaunch")


@pytest.mark.parametrize("draw, message", [
    (drawn.blank, "nothing dark in it"),
    (drawn.open_road, "no closed road"),
    (drawn.figure_eight, "crosses itself")])
def test_a_bad_drawing_leaves_only_a_marked_picture(make_track, tmp_path, draw, message):
    cv2.imwrite("bad.png", drawn.bean())
    assert make_track("bad.png")[0] == 0
    before = files_below(tmp_path / "package")
    picture = draw()
    cv2.imwrite("bad.png", picture)
    code, output, error = make_track("bad.png")
    assert (code, output, error.count("\n")) == (1, "", 1)
    assert message in error and "bad_problem.png" in error
    assert files_below(tmp_path / "package") == before
    shown = cv2.imread("bad_problem.png")
    assert shown.shape[0] > picture.shape[0]
    red = (shown[..., 2] > 180) & (shown[..., 1] < 80)
    assert red.any() == (draw is not drawn.blank)


def test_a_tight_bend_is_a_warning(make_track):
    square = [(300, 200), (900, 200), (900, 600), (300, 600)]
    cv2.imwrite("square.png", drawn.stroke(drawn.blank(), square))
    code, output, _ = make_track("square.png")
    assert code == 0 and "the racecar needs 0.95 m" in output


def test_what_is_no_picture_leaves_none(make_track, tmp_path):
    for content, message in ((b"", "is empty"), (b"no picture", "is not a picture")):
        (tmp_path / "bad.png").write_bytes(content)
        code, output, error = make_track(tmp_path / "bad.png")
        assert (code, output, error.count("\n")) == (1, "", 1)
        assert message in error and "marked" not in error
    assert not list(tmp_path.rglob("*_problem.png"))


WRONG = [
    ((), "give a picture"),
    (("--random", "1", "a.png"), "one of them"),
    (("none.png",), "none.png: No such file"),
    (("none.yaml",), "none.yaml: No such file"),
    (("--random", "1", "--size", "2x3"), "at least"),
    (("--random", "1", "--name", "a/b"), "letters, digits"),
]


@pytest.mark.parametrize("words, message", WRONG)
def test_mistakes_are_one_line(make_track, words, message):
    code, output, error = make_track(*words)
    assert (code, output, error.count("\n")) == (1, "", 1)
    assert message in error


@pytest.mark.parametrize("words, message", [
    (("--size", "12"), "such as 12x8"), (("--size", "0x8"), "above 0, up to 100"),
    (("--width", "0.1"), "too narrow"), (("--road", "blu"), "use '#rrggbb' or one of"),
    (("--start", "1"), "two numbers"), (("--random", "x"), "whole number")])
def test_mistyped_options_say_what_is_meant(make_track, capsys, words, message):
    with pytest.raises(SystemExit) as ended:
        make_track("a.png", *words)
    assert ended.value.code == 2
    assert message in capsys.readouterr().err


TAKEN = ("racecar", "sun", "ground_plane", "walls", "smartcar_plane")


@pytest.mark.parametrize("name", TAKEN)
def test_names_of_other_models_in_the_world_are_refused(make_track, tmp_path, name):
    cv2.imwrite(f"{name}.png", drawn.bean())
    for words in ((f"{name}.png",), ("--random", 1, "--name", name)):
        code, output, error = make_track(*words)
        assert (code, output, error.count("\n")) == (1, "", 1)
        assert f"'{name}'" in error and ", ".join(TAKEN) in error and "--name" in error
    assert not (tmp_path / "package").exists()
    assert make_track(f"{name}.png", "--name", f"{name}_2")[0] == 0


@pytest.mark.parametrize("file", ["a-<-b.png", "a-&->-b.png", "a---b.png"])
def test_any_file_name_leaves_a_world_that_can_be_read(make_track, tmp_path, file):
    cv2.imwrite(file, drawn.bean())
    assert make_track(file, "--name", "odd")[0] == 0
    for made in ("worlds/odd.world", "models/odd/model.config"):
        text = (tmp_path / "package" / made).read_text()
        ElementTree.fromstring(text)
        assert "from a-b.png." in text


def test_a_start_far_from_the_road_is_refused(make_track, tmp_path):
    """A road's width beside the road's edge is the limit, whatever the course is made from."""
    cv2.imwrite("bean.png", drawn.bean())
    for source in (("bean.png",), (RACETRACK,), ("--random", 1)):
        words = (*source, "--name", "made")
        code, output, error = make_track(*words, "--start", "99,99")
        assert (code, output, error.count("\n")) == (1, "", 1)
        assert "--start 99,99 is " in error and " m from the road" in error
        assert not (tmp_path / "package").exists()
        nearest = error.split("--start ")[2].split()[0]
        assert make_track(*words, "--start", nearest, "--out", tmp_path / "else")[0] == 0


@pytest.mark.parametrize("widths, code", [(1.4, 0), (1.6, 1)])
def test_a_start_near_the_road_is_moved_to_its_middle(make_track, tmp_path, widths, code):
    track = load_track_file(RACETRACK)
    x, y, heading = CentreLine(track.corners).pose(0.0)
    beside = widths * road_width(track.lane_width)
    outside = max((1, -1), key=lambda side: np.hypot(
        x - side * np.sin(heading), y + side * np.cos(heading)))
    start = (x - outside * beside * np.sin(heading), y + outside * beside * np.cos(heading))
    words = (RACETRACK, "--name", "made", "--start", f"{start[0]:.6f},{start[1]:.6f}")
    assert make_track(*words)[0] == code
    if code == 0:
        made = load_track_file(tmp_path / "package/tracks/made.yaml")
        assert made.start == pytest.approx((x, y), abs=1e-3)


def test_what_others_made_is_not_overwritten(make_track, tmp_path):
    world = tmp_path / "package/worlds/racetrack.world"
    world.parent.mkdir(parents=True)
    world.write_text("<sdf/>")
    code, _, error = make_track(RACETRACK)
    assert code == 1 and "'racetrack' is taken" in error
    assert world.read_text() == "<sdf/>"


@pytest.mark.parametrize("text, message", [
    ("[", "not valid YAML"), ("name: a", "missing key 'corners'"),
    (RACETRACK.read_text().replace("radius: 1.5}", "radius: 50}"), "bends overlap"),
    (RACETRACK.read_text().replace("start: [0.0, 0.0]", "start: [0.0, 0.5]"), "beside the line"),
    (RACETRACK.read_text() + "colour: red\n", "unknown key 'colour'")])
def test_a_bad_track_file_names_the_key(make_track, text, message):
    Path("line.yaml").write_text(text)
    code, _, error = make_track("line.yaml")
    assert code == 1 and "line.yaml: " in error and message in error


def test_the_script_runs(tmp_path):
    script = PACKAGE / "scripts" / "make_track"
    words = [sys.executable, script, "--random", "2", "--out", tmp_path]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "worlds/random_2.world").is_file()


@pytest.mark.parametrize("words", [("--random", "2"), ("--help",)])
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_reader_that_leaves_early_is_no_error(tmp_path, words, unbuffered):
    """As before `| head`: the course is made, and nothing is said about the closed pipe."""
    reading, writing = os.pipe()
    os.close(reading)
    script = PACKAGE / "scripts" / "make_track"
    done = subprocess.run(
        [sys.executable, script, *words, "--out", tmp_path], stdout=writing,
        stderr=subprocess.PIPE, env={**os.environ, "PYTHONUNBUFFERED": unbuffered})
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, b"")
    assert (tmp_path / "worlds/random_2.world").is_file() == ("--random" in words)
