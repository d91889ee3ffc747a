"""The localisation trials without driving: command line, scores, table, exit codes, steering."""

import json
from dataclasses import replace

import numpy as np
import pytest

from evaluation.course_run.failure import RunError
from evaluation.localisation import main
from evaluation.localisation.options import parse_options
from evaluation.localisation.results import (
    FINDING,
    KIDNAPS,
    Load,
    Results,
    Tracking,
    Trial,
    right_since,
    table,
    trial_line,
    write_report,
)
from evaluation.localisation.trials import errors_since
from evaluation.localisation.wander import SPEED, Steering
from evaluation.navigation.records import Records
from evaluation.program import NOT_RUN

BEARINGS = np.radians(np.arange(-180.0, 180.0))
GOOD = Results(
    [Trial(FINDING, n, (0.0, 0.0, 0.0), 5.0 + n, 0.02, 1.0, 0) for n in range(20)]
    + [Trial(KIDNAPS, n, (0.0, 0.0, 0.0), 90.0, 0.02, 1.0, 0) for n in range(10)],
    Tracking(300.0, 40.0, 0.03, 1.0, 0.1, 4.0), Load(2000, 60.0, 61.0, 6.0))


def without(count, kind, took=None):
    """The good results, but for so many of one set that took so long."""
    spoilt = [trial.number for trial in GOOD.of(kind)[:count]]
    return replace(GOOD, trials=[
        replace(trial, took=took) if trial.set == kind and trial.number in spoilt else trial
        for trial in GOOD.trials])


# --- command line


def test_what_is_tried_by_default_and_when_asked_for():
    found = parse_options([])
    assert (found.tracking, found.load) == (300, 60)
    assert (found.starts, found.kidnaps) == (range(1, 21), range(1, 11))
    assert parse_options(["--kidnaps", "0", "--real-time-factor", "2.5"]).real_time_factor == 2.5


@pytest.mark.parametrize(("arguments", "said"), [
    (["--starts", "many"], "--starts must be a whole number"),
    (["--starts=0", "--kidnaps=0", "--tracking=0", "--load=0"], "nothing to try"),
    (["--real-time-factor", "0"], "--real-time-factor (PACE=) must be"),
    (["--house", "none"], "no house 'none'"),
    (["--out", "/proc/none"], "--out /proc/none: No such file or directory"),
])  # fmt: skip
def test_a_mistake_on_the_command_line_is_one_line(arguments, said, capsys):
    assert main.main(arguments) == NOT_RUN
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert said in line


# --- scores


@pytest.mark.parametrize(("results", "passes"), [
    (GOOD, True),
    (without(1, FINDING), True), (without(2, FINDING), False), (without(2, FINDING, 61.0), False),
    (without(2, KIDNAPS), True), (without(3, KIDNAPS), False),
    (replace(GOOD, tracking=replace(GOOD.tracking, off=0.051)), False),
    (replace(GOOD, tracking=replace(GOOD.tracking, off_deg=2.1)), False),
    (replace(GOOD, load=replace(GOOD.load, percent=31.0)), False),
    (Results(load=GOOD.load), True),
])  # fmt: skip
def test_limits(results, passes):
    assert results.passed is passes


def test_a_robot_without_any_pose_is_told_in_words():
    lost = Trial(FINDING, 1, (0.0, 0.0, 0.0), None, None, None, 0)
    assert trial_line(lost).endswith("not found, no pose at the end")


def test_right_counts_from_the_last_wrong_pose_on():
    times = np.arange(6.0)
    off = np.array([2.0, 0.1, 0.4, 0.29, 0.1, 0.0])
    assert right_since(times, np.column_stack((off, np.zeros(6)))) == 3.0
    assert right_since(times, np.column_stack((off, np.radians([0, 0, 0, 0, 16, 14])))) == 5.0
    assert right_since(times, np.column_stack((off[::-1], np.zeros(6)))) is None
    assert right_since(np.empty(0), np.empty((0, 2))) is None


def test_errors_are_of_the_same_moments_and_not_where_the_truth_was_not_seen():
    records = Records()
    records.truth = [(0.1 * k, 0.02 * k, 0.0, 3.1) for k in range(11)] + [(3.0, 9.0, 0.0, 0.0)]
    records.believed = [(0.25, 0.05, 0.3, -3.1), (0.85, 0.17, 0.0, 3.1), (2.0, 5.0, 0.0, 0.0)]
    times, errors = errors_since(records, 0.2)
    assert times.tolist() == [0.25, 0.85]
    assert errors == pytest.approx(np.array([[0.3, 2 * np.pi - 6.2], [0.0, 0.0]]), abs=1e-9)
    assert len(errors_since(records, 5.0)[0]) == len(errors_since(Records(), 0.0)[0]) == 0


# --- what is shown


def test_the_table_holds_each_figure_against_its_limit(tmp_path):
    rows = table(without(1, FINDING)).splitlines()
    assert [row.split("  ")[0] for row in rows[1:]] == [
        "finding, within 60 s", "kidnaps, within 120 s", "tracking, 300 s",
        "amcl with 2000 particles"]
    assert "19 of 20" in rows[1] and "3.0 cm, 1.0°" in rows[3] and "6 % of a core" in rows[4]
    write_report(GOOD, tmp_path / "report.json")
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["passed"] and report["trials"][0]["right"] and len(report["trials"]) == 30


@pytest.mark.parametrize(("took", "said"), [
    (None, "not found"), (5.0, "found after 5.0 s, at"), (70.0, "70.0 s, too late")])
def test_a_trial_on_one_line(took, said):
    assert said in trial_line(replace(GOOD.trials[0], took=took))


# --- steering


def test_it_turns_to_the_freer_side_until_there_is_room():
    steering, ranges = Steering(0), np.full(360, 3.0)
    assert steering.choose(ranges, BEARINGS)[0] == SPEED
    ranges[170:190], ranges[:170] = 0.5, 1.0  # near ahead, little room on the right
    assert steering.choose(ranges, BEARINGS) == (0.0, 0.8)
    ranges[170:190] = 0.7  # it would have driven on to there, but does not drive off
    assert steering.choose(ranges, BEARINGS) == (0.0, 0.8)
    ranges[170:190] = 0.9
    assert steering.choose(ranges, BEARINGS)[0] == SPEED
    ranges[120] = 0.2  # a table's leg, on the right
    assert steering.choose(ranges, BEARINGS)[0] == 0.0


def test_it_turns_where_it_may_not_go_on():
    steering, ranges = Steering(0), np.full(360, 3.5)
    assert steering.choose(ranges, BEARINGS, may_go_on=False) == (0.0, -0.8)
    assert steering.choose(ranges, BEARINGS)[0] == SPEED


def test_nothing_to_try_names_all_four():
    with pytest.raises(RunError, match="no starts, no kidnaps, no tracking and no load"):
        parse_options(["--starts=0", "--kidnaps=0", "--tracking=0", "--load=0"])
