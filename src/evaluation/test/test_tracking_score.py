"""The rules of a drive after the cylinder, on made-up samples with known answers."""

import json
import math

import cv2
import numpy as np
import pytest
from ai_robot_tracking.scenes.scene import KINDS, MOVING, draw_scene
from ai_robot_tracking.scenes.world_file import RADIUS

from evaluation.lap import Sample
from evaluation.picture import LEGEND_PX, bgr
from evaluation.track import CURVE_PX, SHADE, TrackRun, write_picture
from evaluation.track_score import CAMERA_X, PARTS, Task, TrackScorer
from evaluation.track_trials import SETS, DriveResult, TrackTrial, summarize
from evaluation.trial import run_trial
from run_session.failure import RunError

STANDS = np.array([(0.0, 5.0, 0.0)])
WALKS = np.array([(0.0, 5.0, 0.0), (1000.0, 5.0, 0.0)])  # a walk that does not get on
WANTED = 1.2


def drive(task, distance_at, seconds=200.0):
    """A car that faces the cylinder from a distance (camera to axis, m) that is a function of s."""
    scorer = TrackScorer(task)
    for time in np.arange(0, seconds, 0.1):
        if scorer.over:
            break
        scorer.add(Sample(float(time), 5.0 - distance_at(time) - CAMERA_X, 0.0, 0.0))
    return scorer


def test_kept():
    scorer = drive(Task(WALKS, (), WANTED), lambda time: max(3 - time, WANTED + 0.1))
    assert (scorer.outcome, scorer.good) == ("kept", True)
    assert scorer.approach == pytest.approx(1.5, abs=0.11)
    assert scorer.elapsed == pytest.approx(61.6, abs=0.2)
    assert scorer.judged_errors(3.0) == pytest.approx(0.1)


def test_one_sample_too_far_is_enough():
    scorer = drive(Task(WALKS, (), WANTED),
                   lambda time: WANTED + (0.31 if 20 < time < 20.15 else 0))
    assert (scorer.outcome, scorer.good) == ("distance not kept", False)
    assert scorer.left_at == pytest.approx(20.1, abs=0.1)


def test_not_reached_in_time():
    scorer = drive(Task(WALKS, (), WANTED), lambda time: 3.0)
    assert (scorer.outcome, scorer.good) == ("not reached", False)
    assert scorer.elapsed == pytest.approx(20.1, abs=0.2)


def test_a_standing_one_is_given_the_whole_time_and_then_5_s():
    scorer = drive(Task(STANDS, (), WANTED, limit=60), lambda time: 3.0 if time < 50 else WANTED)
    assert scorer.good
    assert scorer.elapsed == pytest.approx(55.1, abs=0.2)
    assert not drive(Task(STANDS, (), WANTED, limit=40), lambda time: 3.0).good


def test_reaching_is_10_cm_before_it():
    offset = PARTS[0, 0] - CAMERA_X
    scorer = drive(Task(STANDS, (), None), lambda time: 3.0 - 0.2 * time)
    assert scorer.outcome == "reached"
    assert scorer.least_gap == pytest.approx(0.09, abs=0.02)
    last = 5.0 - scorer.samples[-1].x - CAMERA_X
    assert last - offset - RADIUS < 0.1


@pytest.mark.parametrize(("place", "yaw", "gap"), [
    ((5 - 0.15 - 0.2 - 0.5, 0.0), 0.0, 0.5),       # its front
    ((5 + 0.15 + 0.2 + 0.5, 0.0), 0.0, 0.5),       # its back
    ((5.0, 0.15 + 0.2 + 0.4), 0.0, 0.4),           # a wheel
    ((5 - 0.15 - 0.3, -0.11 - 0.4), 0.0, 0.3),     # a corner, 0.5 m from the axis
    ((5 - 0.15 - 0.2 - 0.5, 0.0), math.pi, 0.5),
])
def test_the_gap_is_that_of_the_cars_outline(place, yaw, gap):
    scorer = TrackScorer(Task(STANDS, (), WANTED))
    scorer.add(Sample(0.0, *place, yaw))
    assert scorer.least_gap == pytest.approx(gap, abs=1e-9)


def hidden_drive(back_at):
    """Away while it is hidden at 10 s, back so many s after the hood's rising at 13 s."""
    return drive(Task(WALKS, (10.0,), WANTED),
                 lambda time: 2.5 if 11 < time < 13 + back_at else WANTED)


def test_found_again():
    scorer = hidden_drive(4.0)
    assert (scorer.outcome, scorer.good) == ("kept", True)
    assert scorer.hidings[0].found_after == pytest.approx(4.0, abs=0.15)
    assert scorer.elapsed < 25


def test_found_too_late_or_only_for_a_moment():
    assert hidden_drive(10.5).outcome == "not found again"
    assert hidden_drive(50).outcome == "not found again"
    scorer = drive(Task(WALKS, (10.0,), WANTED),
                   lambda time: WANTED if time < 11 or 15 < time < 16 else 2.5)
    assert scorer.outcome == "not found again"


@pytest.mark.parametrize("hidden", [(), (0.0, 40.0)])
def test_a_drive_that_ends_at_once_is_drawn_with_the_hidden_times_in_its_legend(tmp_path, hidden):
    scorer = drive(Task(WALKS, hidden, WANTED), lambda time: 2.5, seconds=0.1)
    write_picture(tmp_path / "path.png", draw_scene(MOVING, 0), scorer, ["title"])
    picture = cv2.imread(str(tmp_path / "path.png"))
    below = LEGEND_PX + 30  # with the edges of both
    for rows in (picture[-LEGEND_PX - 10:], picture[-CURVE_PX - below:-below]):
        assert ((rows == bgr(SHADE)).all(axis=2).sum() > 100) == bool(hidden)


def test_near_but_turned_away_is_not_found():
    scorer = TrackScorer(Task(WALKS, (10.0,), WANTED))
    for time in np.arange(0, 60, 0.1):
        yaw = 0.0 if time < 10 else math.pi
        x = 5.0 - WANTED - CAMERA_X * math.cos(yaw)
        scorer.add(Sample(float(time), x, 0.0, yaw))
    assert scorer.hidings[0].found_after is None


@pytest.mark.parametrize(("words", "said"), [
    (["--scene", "dark"], KINDS[0]), (["--tracker", "mine.py"], "visual_tracker.py"),
    (["--seed", "-1"], "whole number"), (["--seed", "x"], "whole number"),
    (["--keep", "0"], "seconds"), (["--speed", "1"], "--help"),
])
def test_mistakes_are_one_line_that_says_what_to_type(words, said):
    with pytest.raises(RunError, match=said) as raised:
        TrackRun.parse(words)
    assert "\n" not in str(raised.value)


def report(seed, good, hidden=()):
    return {"seed": seed, "good": good, "approach_s": 1.0 if good else None, "rms_error_m": 0.1,
            "max_error_m": 0.2, "max_error_settled_m": 0.15, "least_gap_m": 0.5, "outcome": "kept",
            "real_time_factor": 1.0, "hidden": [{"begin_s": 1, "found_after_s": s} for s in hidden]}


def summary(name, reports):
    (found,) = summarize([DriveResult(f"{name}/{each['seed']}", name, each) for each in reports])
    assert found["set"] in SETS
    return found


def test_summaries():
    assert summary("follow", [report(0, True), report(1, True)])["passed"]
    one_bad = summary("follow", [report(0, True), report(1, False)])
    shown = [one_bad[key] for key in ("good", "cases", "passed", "failed_seeds")]
    assert shown == [1, 2, False, [1]]
    hidden = [report(seed, True, (2.0, 9.0)) for seed in range(9)]
    assert summary("hidden", [*hidden, report(9, False, (11.0, None))])["passed"]  # 18 of 20
    assert not summary("hidden", [*hidden[1:], report(8, False, (3.0, None)),
                                  report(9, False, (11.0, None))])["passed"]
    drives = [*hidden, report(9, False, (11.0, 12.0))]
    assert "18 of 20" in TrackTrial().table([DriveResult(str(n), "hidden", each)
                                             for n, each in enumerate(drives)])


@pytest.mark.parametrize(("good", "code"), [(True, 0), (False, 1)])
def test_trials_go_on_from_what_is_there_and_count(tmp_path, capsys, good, code):
    for seed in (0, 1):
        folder = tmp_path / "stand" / str(seed)
        folder.mkdir(parents=True)
        (folder / "report.json").write_text(json.dumps(report(seed, good)))
    words = ["--sets", "stand", "--seeds", "2", "--resume", "--out", str(tmp_path)]
    assert run_trial(TrackTrial(), words) == code
    assert f"{2 * good} of 2" in capsys.readouterr().out
    assert json.loads((tmp_path / "report.json").read_text())["summaries"][0]["cases"] == 2


def test_half_a_drive_is_none_to_go_on_from(tmp_path):
    """A program that is killed leaves its drive's report, of what was seen by then."""
    scorer = TrackScorer(Task(STANDS, (), WANTED))
    scorer.add(Sample(0.0, 0.0, 0.0, 0.0))
    for seed, outcome in ((0, "not reached"), (1, scorer.outcome)):
        folder = tmp_path / "stand" / str(seed)
        folder.mkdir(parents=True)
        (folder / "report.json").write_text(json.dumps({**report(seed, False), "outcome": outcome}))
    trial = TrackTrial()
    options = trial.parse(["--sets", "stand", "--seeds", "2", "--resume", "--out", str(tmp_path)])
    assert [each.name for each in trial.earlier(options)] == ["stand/0"]


def test_a_damaged_report_of_a_drive_is_one_line(tmp_path, capsys):
    folder = tmp_path / "stand" / "0"
    folder.mkdir(parents=True)
    (folder / "report.json").write_text("{")
    words = ["--sets", "stand", "--seeds", "1", "--resume", "--out", str(tmp_path)]
    assert run_trial(TrackTrial(), words) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1 and str(folder / "report.json") in said[0]


def test_no_drives_are_refused(capsys):
    assert run_trial(TrackTrial(), ["--seeds", "0"]) == 2
    assert "nothing to drive" in capsys.readouterr().err
