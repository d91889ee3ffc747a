"""Figures of a navigation run, on records that are known; no ROS."""

import json
import re
import subprocess

import numpy as np
import pytest

from evaluation.house import Records, load_house
from evaluation.live import Outcome
from evaluation.navigate import NavigationRun
from evaluation.navigate_parts import keep_map, place_for_map, read_map_frame
from evaluation.navigate_pictures import CLEAR, map_picture
from evaluation.navigate_score import (
    Result,
    lines,
    localisation,
    mapping_figures,
    mismatch,
    seen_of,
    summarize,
    way,
)
from evaluation.picture import bgr, lap_colour
from nav_algorithms.cells import OCCUPIED, UNKNOWN, OccupancyGrid
from nav_algorithms.poses import compose, invert
from run_session.failure import RunError
from run_session.files import find_package
from trial_worlds.feelers import Gap
from trial_worlds.house import Ground

PACE = {"simulated_s": 100.0, "wall_s": 200.0, "real_time_factor": 0.5,
        "cpu_percent_of_a_core": {"move_base": 40.0}}
SHIFT = np.array([0.5, -0.2, 0.3])  # the map's frame in the world's
ANGLES = np.arange(360) * np.pi / 180


def goals(ways, place, **seen) -> Result:
    """The goals of a run in which nothing was touched."""
    usual = dict(contacts=[], nearest_m=0.1, longest_unseen_s=0.04, distance_m=4.2)
    return Result(navigation={**PACE, **usual, **seen, **place, "goals": ways})


def drive(reached: bool = True, text: str = "Goal reached.", off_yaw: float = 0.1) -> dict:
    return way((1.0, 2.0, 0.5), (1.03, 2.0, 0.5 + off_yaw), reached, text, time_s=20.0,
               straight_s=11.5, shortest_s=15.4, driven_m=4.2)


def mapping(ground: Ground, built: OccupancyGrid, records: Records, ways: list[dict]) -> Result:
    """The mapping part, judged by the map and the records."""
    figures, there = mapping_figures(ground, built, records, ANGLES, 3.0)
    return Result(built, there,
                  {**PACE, **seen_of(records), **figures, "way_points": ways})


@pytest.fixture(scope="module")
def ground():
    return load_house("house").ground()


@pytest.fixture(scope="module")
def urdf():
    folder = find_package("turtlebot3_description") / "urdf"
    done = subprocess.run(["xacro", str(folder / "turtlebot3_waffle.urdf.xacro")],
                          capture_output=True, text=True, check=True)
    return done.stdout


def records_of(poses: np.ndarray, error: np.ndarray = np.zeros(3),
               map_in_world: np.ndarray = SHIFT) -> Records:
    """A drive of ten poses a second; the believed ones are on the map, and wrong by `error`."""
    records = Records()
    believed = compose(invert(map_in_world), poses) + error
    for number, (true, thought) in enumerate(zip(poses, believed)):
        records.truth.append((number / 10, *true.tolist()))
        records.believed.append((number / 10, *thought.tolist()))
    return records


def round_of(ground: Ground) -> np.ndarray:
    """Twenty poses from each way-point to the next."""
    points = np.array(load_house("house").way_points)
    at, known = np.arange(0.0, len(points) - 1, 0.05), np.arange(len(points))
    return np.stack((*(np.interp(at, known, column) for column in points.T), at % 3), axis=1)


def test_touching_again_within_half_a_second_is_one_contact():
    records = Records()
    for now, width in ((0.5, 0.1), (1.0, 0.004), (1.2, 0.01), (1.4, 0.0), (3.0, -0.001), (4.0, 1)):
        records.note_gap(Gap(width, "wheel", (1.0, 2.0)), now)
    assert [(each.begin, each.end) for each in records.contacts] == [(1.0, 1.4), (3.0, 3.0)]
    assert records.contacts[0].own == "wheel" and records.nearest == (-0.001, 3.0)


@pytest.mark.parametrize("pose, own, width", [
    # The eastern outer wall begins at 7.525; the wheels' outer sides lie 0.153 from the middle.
    ((7.3, -1.0, 0.0), "camera", 7.525 - 7.3 - 0.073),
    ((7.3, -1.0, np.pi), "base_link", 7.525 - 7.3 - 0.197),
    ((7.3, -1.0, np.pi / 2), "wheel_right", 7.525 - 7.3 - 0.153),
    ((7.3, -1.0, -np.pi / 2), "wheel_left", 7.525 - 7.3 - 0.153),
    ((7.372, -1.0, np.pi / 2), "wheel_right", 0.0),
    # Between the legs of the kitchen table, 0.025 m thick, 0.78 m apart; and before one of them.
    ((2.6, -2.4 + 0.1, 0.0), "base_", np.hypot(0.39 - 0.197, 0.39 - 0.1 - 0.133) - 0.025),
    ((2.6 + 0.39 - 0.2, -2.4 + 0.39, 0.0), "camera", 0.2 - 0.025 - 0.073),
    ((0.0, 1.5, 0.3), "", 0.5)])
def test_gaps_are_those_of_the_shapes(ground, urdf, pose, own, width):
    gap = ground.feelers(urdf).gap(np.array(pose))
    assert gap.width == pytest.approx(width, abs=0.003) and own in gap.own


def test_poses_are_compared_at_the_same_moments():
    records = Records(truth=[(0.0, 0.0, 0.0, 0.0), (0.1, 1.0, 0.0, 0.2), (0.4, 1.0, 0.0, 3.0)],
                      believed=[(-1.0, 9.0, 9.0, 0.0), (0.0, 0.0, 0.0, 0.0), (0.05, 0.5, 0.1, 0.1),
                                (0.3, 1.0, 0.0, 2.0), (2.0, 9.0, 9.0, 0.0)])
    _, believed, true = records.moments()  # 0.3 s without a look: it may have turned either way
    assert believed.tolist() == [[0.0, 0.0, 0.0], [0.5, 0.1, 0.1]]
    assert true[1] == pytest.approx([0.5, 0.0, 0.1])
    assert len(records.moments(since=0.06)[0]) == 0
    assert records.length == 1.0 and records.now == 0.4
    assert records.longest_unseen == pytest.approx(0.3)


def test_only_looks_that_a_drive_missed_count():
    records = Records(truth=[(time, 0.0, 0.0, 0.0) for time in (0.0, 2.0, 2.1, 2.5)])
    assert records.longest_unseen == 2.0
    records.begun = 2.0
    assert records.longest_unseen == pytest.approx(0.4)


def test_errors_of_localisation_are_taken_in_the_world():
    records = records_of(np.random.default_rng(0).normal(size=(10, 3)), np.array([0.03, 0.04, 0.1]))
    errors = records.errors(0.4, SHIFT)[1]
    assert errors == pytest.approx(np.tile([0.05, 0.1], (6, 1)))
    found = localisation((0.2, 0.1), errors)
    for error in ("mean_off", "largest_off", "found_off"):
        assert found[error] == {"m": 0.05, "deg": 5.73}
    part = goals([drive()], found)
    assert part.faults == ["localisation: 5.0 cm and 5.7° off in the mean, more than 5.0 cm and 2°"]
    unknown = localisation(None, errors[:0])
    assert unknown["mean_off"] == {"m": None, "deg": None}
    assert goals([drive()], unknown).faults  # nothing known is no success


def test_a_right_map_in_a_frame_of_its_own_has_no_fault(ground):
    walls, shift = ground.walls, np.array([0.52, -0.21, 0.0])
    built = OccupancyGrid(walls.cells, walls.resolution, tuple(walls.origin - shift[:2]))
    records = records_of(round_of(ground), map_in_world=shift)
    part = mapping(ground, built, records, [drive()])
    assert part.faults == [] and part.mapping["ate_rmse_m"] == 0.0
    assert part.map_in_world == pytest.approx(shift, abs=1e-6)
    assert part.mapping["walls_found"] == 1.0 and part.mapping["wall_cells"] > 1500
    assert 100.0 < part.mapping["known_m2"] < 160.0


def test_each_fault_of_a_mapping_round_is_a_line(ground):
    poses = round_of(ground)
    error = np.column_stack((0.1 * (-1) ** np.arange(len(poses)), *np.zeros((2, len(poses)))))
    records = records_of(poses, error, np.zeros(3))
    records.note_gap(Gap(0.001, "wheel", (1.0, 2.0)), 1.0)
    cells = ground.walls.cells.copy()
    cells[:, 150:] = UNKNOWN  # half of the house is not on the map
    cells[100:110, 20:40] = OCCUPIED  # and something that is not there
    built = OccupancyGrid(cells, ground.walls.resolution, ground.walls.origin)
    ways = [drive(), drive(False, "time is up")]
    faults = mapping(ground, built, records, ways).faults
    wanted = (r"mapping: trajectory error 10\.0 cm, more than 5\.0 cm",
              r"mapping: occupied cells near true walls [89]\d\.\d%, less than 95%",
              r"mapping: seen walls on the map [3-6]\d\.\d%, less than 95%",
              r"way-point 2 \(1\.00, 2\.00\) not reached: time is up",
              r"mapping: wheel touched something at 1\.0 s, \(1\.0, 2\.0\)")
    for fault, text in zip(faults, wanted, strict=True):
        assert re.fullmatch(text, fault), fault


def test_what_was_not_looked_at_is_not_called_right(ground):
    """On a machine that is too busy."""
    records = records_of(round_of(ground)[:6])
    records.truth = [(9 * number, *pose) for number, (_, *pose) in enumerate(records.truth)]
    part = goals([drive()], localisation(None, np.zeros((1, 2))), **seen_of(records))
    assert [fault for fault in part.faults if "nobody looked for 9.0 s" in fault] == part.faults
    records.truth = [(99.0, 0.0, 0.0, 0.0)]
    with pytest.raises(RunError, match="too busy"):
        mapping_figures(ground, ground.walls, records, ANGLES, 3.0)


def test_a_goal_that_is_only_called_reached_is_a_fault():
    place = localisation(None, np.zeros((1, 2)))
    assert goals([drive(), drive(off_yaw=1.6)], place).faults == [
        "goal 2 (1.00, 2.00) called reached, but 3.0 cm and 92° off"]


def test_a_map_brings_its_frame_along(tmp_path, ground):
    made, kept = place_for_map(tmp_path), tmp_path / "map.yaml"
    for map_file in (made, kept):
        map_file.write_text(str(map_file))
    assert (read_map_frame(kept) == 0).all()
    keep_map(made, SHIFT)
    assert kept.read_text() == str(made) and not made.exists()
    (tmp_path / "report.json").write_text('{"map_in_world": [9, 9, 9]}')  # of a later run
    assert read_map_frame(kept) == pytest.approx(SHIFT)
    kept.with_suffix(".json").write_text('{"map_in_world": "here"}')
    assert read_map_frame(kept) == pytest.approx([9, 9, 9])


def test_report_table_and_picture_of_a_run(tmp_path, ground):
    records = records_of(round_of(ground))
    errors = records.errors(0.0, SHIFT)[1]
    place = localisation((0.2, 0.1), errors)
    missed = drive(False, "Failed to find a valid plan. Even after executing recovery behaviors.")
    result = goals([drive(), missed], place, distance_m=8.4)
    result.map = ground.walls
    result.paths["goals"] = np.array(records.truth)[:, 1:3]
    options = NavigationRun.parse(["--goals", "2", "--seed", "7", "--out", str(tmp_path)])
    report = json.loads(json.dumps(summarize(options, Outcome("not passed", "why"), result)))
    assert report["goals_reached"] == 1 and report["goals_wanted"] == 2 and report["seed"] == 7
    first = report["navigation"]["goals"][0]
    assert first["time_s"] == 20.0 and first["straight_s"] == 11.5
    assert report["navigation"]["cpu_percent_of_a_core"] == {"move_base": 40.0}
    assert report["navigation"]["real_time_factor"] == 0.5
    table = lines(result)
    assert table[1].split()[:4] == ["1", "1.00", "2.00", "yes"]
    assert "Failed to find a valid plan." in table[2]
    picture = map_picture(ground, result, "title", "figures")
    assert picture.shape[1:] == (1400, 3)
    colours = {tuple(colour) for colour in picture.reshape(-1, 3)[::7].tolist()}
    assert {bgr(CLEAR), bgr(lap_colour(3))} <= colours  # free cells, the way to the goals


@pytest.mark.parametrize("arguments, said", [
    (["--goals", "0"], r"--goals \(GOALS=\) must be a whole number, 1 to 999999; got '0'"),
    (["--goals", "five"], "GOALS="), (["--seed", "-1"], "SEED="),
    (["--real-time-factor", "0"], "PACE="), (["--real-time-factor", "fast"], "PACE="),
    (["--real-time-factor", "nan"], "PACE="),
    (["--map", "/nowhere.yaml"], "no such file"), (["--gaols", "3"], "--help"),
    (["--house", "hut"], "there are: house")])
def test_a_mistyped_option_is_one_line(arguments, said):
    with pytest.raises(RunError, match=said) as found:
        NavigationRun.parse(arguments)
    assert "\n" not in str(found.value)


def test_a_map_of_another_world_is_said_at_the_start(capsys):
    ground = load_house("house").ground()
    walls = ground.walls
    assert mismatch(ground, walls, np.zeros(3)) is None
    other = find_package("nav_demo") / "map" / "nav.yaml"
    NavigationRun(NavigationRun.parse(["--map", str(other)]))
    assert f"--map {other}: the map does not fit this house: only 5% of" in capsys.readouterr().out
