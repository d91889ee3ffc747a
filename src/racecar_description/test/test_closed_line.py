"""The track's geometry against known answers, the shipped tracks, and broken track files."""

import math
import time
from pathlib import Path

import numpy as np
import pytest
import rospkg
from kinematic_follower import drive
from racecar_description.track.centre_line import Corner, Piece
from racecar_description.track.closed_line import Track, build_track, load_track
from racecar_description.track.errors import TrackError
from racecar_description.track.track_file import TrackFile, load_track_file

SHIPPED = sorted((Path(rospkg.RosPack().get_path("evaluation")) / "tracks").glob("*.yaml"))
RADII = {"course": (0.5, 1.1), "lane": (1.2, 1.8)}  # m, of bends
MIDDLE = {"course": (0.0, 0.0), "lane": (0.0, 3.75)}  # m, of the painted plane
TRACK = """name: course
size: 4.0
model_yaw: -1.54
line_width: 0.019
lane_width: 0.296
start: [0.0, 0.0]
corners:
  - {x: 0.45, y: 0.0, radius: 1.0}
  - {x: 1.3, y: 0.6, radius: 0.6}
  - {x: 1.82, y: -0.18, radius: 0.65}
  - {x: 1.45, y: -1.77, radius: 0.8}
  - {x: -0.1, y: -1.77, radius: 1.1}
  - {x: -1.75, y: -1.4, radius: 0.75}
  - {x: -1.8, y: 1.2, radius: 0.6}
  - {x: -0.5, y: 0.0, radius: 0.9}
"""
BROKEN = {  # what is replaced in TRACK, by what, and the mistake that is named
    "missing_key": ("lane_width: 0.296\n", "", "missing key 'lane_width'"),
    "unknown_key": ("size: 4.0", "sizes: 1\nsize: 4.0",
                    "unknown key 'sizes'; there are: name, size"),
    "corner_not_a_number": ("radius: 1.1", "radius: wide",
                            "corners[4].radius: must be a number above 0 and up to 10000, is"
                            " 'wide'"),
    "corner_far_away": ("radius: 1.1", "radius: 42949672955.9",
                        "corners[4].radius: must be a number above 0 and up to 10000,"
                        " is 42949672955.9"),
    "corner_key_missing": (", radius: 1.1", "",
                           "missing key 'corners[4].radius'; there are: x, y, radius"),
    "bends_overlap": ("radius: 0.6}", "radius: 3.0}", "corners[0] and [1]: the bends overlap by"),
    "start_beside_line": ("[0.0, 0.0]", "[0.0, 0.5]", "start: 0.500 m beside the line"),
    "negative_width": ("0.019", "-0.019", "line_width: must be a number above 0 and up to 10000, "
                       "is -0.019"),
    "no_yaml": (TRACK, "name: [course\n", "not valid YAML: "),
    "no_mapping": (TRACK, "- just\n- a list\n", "missing key 'corners'; there are: name, size"),
}


def rounded_square(side: float = 2.0, radius: float = 0.5) -> Track:
    """Counter-clockwise, from the middle of its lower side at (0, 0)."""
    half = side / 2
    xy = ((half, 0.0), (half, side), (-half, side), (-half, 0.0))
    corners = tuple(Corner(x, y, radius) for x, y in xy)
    return build_track(TrackFile("square", 4.0, 0.0, 0.02, 0.3, (0.0, 0.0), corners))


def test_rounded_square_has_the_length_of_its_straights_and_its_circle():
    assert rounded_square().length == pytest.approx(4 * 1.0 + 2 * math.pi * 0.5, abs=1e-12)


def test_poses_of_a_rounded_square():
    track = rounded_square()
    assert track.pose(0.25) == pytest.approx((0.25, 0.0, 0.0))
    bend = math.pi * 0.5 / 4  # half of a quarter circle
    x, y, heading = track.pose(0.5 + bend)
    assert (x, y) == pytest.approx((0.5 + 0.5 * math.sqrt(0.5), 0.5 - 0.5 * math.sqrt(0.5)))
    assert heading == pytest.approx(math.pi / 4)
    assert track.pose(track.length + 0.25)[:2] == pytest.approx((0.25, 0.0))
    assert track.pose(-0.25)[:2] == pytest.approx((-0.25, 0.0))


@pytest.mark.parametrize("left", [-0.2, -0.01, 0.01, 0.2])
def test_nearest_finds_back_what_pose_gave(left):
    track = rounded_square()
    for i in range(200):
        s = track.length * i / 200
        x, y, heading = track.pose(s)
        near = track.nearest(x - left * math.sin(heading), y + left * math.cos(heading))
        assert near.lateral == pytest.approx(left, abs=1e-9)
        assert math.remainder(near.s - s, track.length) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_nearest_is_the_nearest_of_all_pieces_also_far_away(path):
    track, random = load_track(path), np.random.default_rng(3)
    spread = track.length / 2
    for x, y in random.uniform(-spread, spread, (300, 2)).tolist():
        away = [math.dist((x, y), piece.pose(piece.nearest(x, y))[:2]) for piece in track.pieces]
        assert abs(track.nearest(x, y).lateral) == pytest.approx(min(away), abs=1e-12)


def test_offset_to_the_right_of_a_left_circle_is_longer():
    track = rounded_square()
    assert track.offset(-0.3).length == pytest.approx(track.length + 2 * math.pi * 0.3)
    with pytest.raises(TrackError, match="no line"):
        track.offset(0.6)


def test_a_line_of_many_corners_is_read_in_time_that_grows_as_it_does(tmp_path):
    count, path = 8000, tmp_path / "track.yaml"
    corners = [(40.0 * math.cos(2 * math.pi * i / count), 40.0 * math.sin(2 * math.pi * i / count))
               for i in range(count)]
    path.write_text(
        "name: a\nsize: 100\nmodel_yaw: 0\nline_width: 0.05\nlane_width: 0.3\n"
        f"start: [{(corners[0][0] + corners[1][0]) / 2:.6f}, {corners[1][1] / 2:.6f}]\ncorners:\n"
        + "".join(f"- {{x: {x:.6f}, y: {y:.6f}, radius: 0.5}}\n" for x, y in corners))
    began = time.process_time()
    assert load_track(path).length == pytest.approx(80 * math.pi, rel=1e-5)
    assert time.process_time() - began < 8.0  # 1.8; it was 17


def test_an_open_line_is_refused():
    with pytest.raises(TrackError, match="gap of"):
        Track((Piece(0, 0, 0, 1.0, 0.0), Piece(1.0, 1e-6, 0.0, 1.0, 0.0)))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_track_keeps_its_promises(path):
    track_file, track = load_track_file(path), load_track(path)
    curvatures = [piece.curvature for piece in track.pieces]
    radii = [1 / abs(curvature) for curvature in curvatures if curvature]
    assert min(curvatures) < 0 < max(curvatures) and 0.0 in curvatures
    least, most = RADII[path.stem]
    assert least <= min(radii) <= max(radii) <= most
    assert track.pose(0.0) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    lines = track.points(0.02) + track.offset(-track_file.lane_width).points(0.02)
    middle_x, middle_y = MIDDLE[path.stem]
    reach = max(max(abs(x - middle_x), abs(y - middle_y)) for x, y in lines)
    assert reach < track_file.size / 2 - 0.1


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_parts_of_the_yellow_line_stay_apart(path):
    track, spacing = load_track(path), 0.05
    points = track.points(spacing)
    apart = round(1.4 / spacing)  # samples; nearer along the line than this is the same part
    count = len(points)
    for i in range(count):
        for j in range(i + apart, min(count, i + count - apart)):
            assert math.dist(points[i], points[j]) > 0.7


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_lesson_05_stays_on_a_shipped_track_for_three_laps(path):
    track = load_track(path)
    result = drive(track, duration=3 * track.length / 0.15)
    lateral = [track.nearest(x, y).lateral for x, y, _ in result.poses]
    rms = math.sqrt(sum(value * value for value in lateral) / len(lateral))
    assert result.lost == 0
    assert 0.03 < rms < 0.06
    assert max(map(abs, lateral)) < 0.15


def test_the_track_that_is_broken_is_sound(tmp_path):
    path = tmp_path / "track.yaml"
    path.write_text(TRACK)
    assert load_track(path).length > 1.0


@pytest.mark.parametrize("old, new, mistake", BROKEN.values(), ids=BROKEN)
def test_broken_track_file_is_named_with_its_mistake(tmp_path, old, new, mistake):
    path = tmp_path / "track.yaml"
    path.write_text(TRACK.replace(old, new))
    with pytest.raises(TrackError) as caught:
        load_track(path)
    assert str(path) in str(caught.value)
    assert mistake in str(caught.value)
    assert "\n" not in str(caught.value)


def test_missing_track_file_is_named():
    with pytest.raises(TrackError, match=r"nowhere\.yaml: No such file"):
        load_track("nowhere.yaml")


def test_a_track_file_that_is_no_text_is_named(tmp_path):
    (tmp_path / "picture.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(TrackError, match=r"picture\.yaml: not a text file"):
        load_track(tmp_path / "picture.yaml")


MERGES = "a: &a {x: 1}\n" + "".join(
    f"{new}: &{new} {{<<: [{', '.join([f'*{old}'] * 9)}]}}\n"
    for old, new in zip("abcdefghi", "bcdefghij"))


@pytest.mark.parametrize("text", [
    "[" * 3000, "name: 2020-13-45", "size: " + "9" * 5000, "size: !!int ''", "size: !!bool x",
    MERGES])
def test_what_the_yaml_parser_gives_up_on_is_no_yaml(tmp_path, text):
    (tmp_path / "track.yaml").write_text(text)
    with pytest.raises(TrackError, match=r"track\.yaml: not valid YAML: ") as caught:
        load_track(tmp_path / "track.yaml")
    assert len(str(caught.value)) < 1000


@pytest.mark.parametrize("key", ["name", "size", "start"])
def test_a_list_of_aliases_is_named_and_not_spelt_out(tmp_path, key):
    bomb = ", ".join(f"&b{n} [{', '.join([f'*b{n - 1}' if n else 'a'] * 10)}]" for n in range(9))
    lines = TRACK.splitlines()
    path = tmp_path / "track.yaml"
    path.write_text("\n".join(f"{key}: [{bomb}]" if line.startswith(f"{key}:") else line
                              for line in lines))
    began = time.process_time()
    with pytest.raises(TrackError, match=f"{key}: must be "):
        load_track(path)
    assert time.process_time() - began < 2
