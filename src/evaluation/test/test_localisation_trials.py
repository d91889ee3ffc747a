"""The localisation trials without driving: command line, scores, table, exit codes, steering."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from sensor_msgs.msg import LaserScan

from evaluation import localisation_drive
from evaluation.command_line import NOT_RUN
from evaluation.house import Records
from evaluation.localisation_drive import (
    FINDING,
    KIDNAPS,
    SPEED,
    LocalisationCase,
    Record,
    Steering,
    right_since,
)
from evaluation.localisation_trials import Load, LocalisationTrial, Search, Tracking
from evaluation.trial import run_trial
from run_session.failure import RunError

BEARINGS = np.radians(np.arange(-180.0, 180.0))
TRIALS = [*(Search(FINDING, n, (0.0, 0.0, 0.0), 5.0 + n, 0.02, 1.0, 0) for n in range(20)),
          *(Search(KIDNAPS, n, (0.0, 0.0, 0.0), 90.0, 0.02, 1.0, 0) for n in range(10))]
TRACKING, LOAD = Tracking(300.0, 40.0, 0.03, 1.0, 0.1, 4.0), Load(2000, 60.0, 61.0, 6.0)
GOOD = [*TRIALS, TRACKING, LOAD]


def without(count, kind, took=None):
    """The good results, but for so many of one set that took so long."""
    return [replace(each, took=took) if each.name in {f"{kind}-{n}" for n in range(count)}
            else each for each in GOOD]


# --- command line


def test_what_is_tried_by_default_and_when_asked_for():
    trial = LocalisationTrial()
    cases = trial.cases(trial.parse([]))
    assert [(each.name, each.seconds) for each in cases[-2:]] == [("tracking", 300), ("load", 60)]
    assert [each.seed for each in cases[:-2]] == [*range(1, 21), *range(1, 11)]
    assert trial.parse(["--kidnaps", "0", "--real-time-factor", "2.5"]).real_time_factor == 2.5


@pytest.mark.parametrize(("arguments", "said"), [
    (["--starts", "many"], "--starts (STARTS=) must be a whole number"),
    (["--starts=0", "--kidnaps=0", "--tracking=0", "--load=0"], "nothing to try"),
    (["--real-time-factor", "0"], "--real-time-factor (PACE=) must be"),
    (["--house", "none"], "no house 'none'"),
    (["--out", "/proc/none"], "--out /proc/none: No such file or directory"),
])
def test_a_mistake_on_the_command_line_is_one_line(arguments, said, capsys):
    assert run_trial(LocalisationTrial(), arguments) == NOT_RUN
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert said in line


# --- scores


@pytest.mark.parametrize(("results", "passes"), [
    (GOOD, True),
    (without(1, FINDING), True), (without(2, FINDING), False), (without(2, FINDING, 61.0), False),
    (without(2, KIDNAPS), True), (without(3, KIDNAPS), False),
    ([*TRIALS, replace(TRACKING, off=0.051), LOAD], False),
    ([*TRIALS, replace(TRACKING, off_deg=2.1), LOAD], False),
    ([*TRIALS, TRACKING, replace(LOAD, percent=31.0)], False),
    ([LOAD], True),
])
def test_limits(results, passes):
    assert LocalisationTrial().passed(results) is passes


def test_a_robot_without_any_pose_is_told_in_words():
    lost = Search(FINDING, 1, (0.0, 0.0, 0.0), None, None, None, 0)
    assert lost.line.endswith("not found, no pose at the end")


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
    times, errors = records.errors(0.2)
    assert times.tolist() == [0.25, 0.85]
    assert errors == pytest.approx(np.array([[0.3, 2 * np.pi - 6.2], [0.0, 0.0]]), abs=1e-9)
    assert len(records.errors(5.0)[0]) == len(Records().errors(0.0)[0]) == 0


def search(off, until=21.0):
    """A robot that is off by so much (m) until 1 s and right from then until this time, s."""
    times = np.arange(0.0, until, 0.5)
    errors = np.column_stack((np.where(times < 1.0, off, 0.01), np.zeros(len(times))))
    return LocalisationTrial().judge(
        Record(LocalisationCase("finding-1", FINDING, 1), np.zeros(3), times, errors))


def test_found_is_who_was_right_for_long_enough():
    assert (search(2.0, 22.0).took, search(2.0, 22.0).off) == (1.0, 0.01)
    assert search(2.0, 20.0).took is None


def test_a_long_drive_is_judged_by_what_it_is_for():
    errors = np.array([[0.02, np.radians(1.0)], [0.06, np.radians(3.0)]])
    tracking, load = (
        Record(LocalisationCase(kind, kind, seconds=60), np.zeros(3), np.arange(2.0), errors,
               simulated=50.0, wall=100.0, driven=12.0, cpu=5.0) for kind in ("tracking", "load"))
    trial = LocalisationTrial()
    assert trial.judge(tracking) == Tracking(60, 12.0, *map(pytest.approx, (0.04, 2.0, 0.06, 3.0)))
    assert trial.judge(load) == Load(2000, 50.0, 100.0, 10.0)
    with pytest.raises(RunError, match="amcl said no pose"):
        trial.judge(replace(tracking, times=np.empty(0), errors=np.empty((0, 2))))


# --- what is shown


def test_the_table_holds_each_figure_against_its_limit():
    rows = LocalisationTrial().table(without(1, FINDING)).splitlines()
    assert [row.split("  ")[0] for row in rows[1:]] == [
        "finding, within 60 s", "kidnaps, within 120 s", "tracking, 300 s",
        "amcl with 2000 particles"]
    assert "19 of 20" in rows[1] and "3.0 cm, 1.0°" in rows[3] and "6 % of a core" in rows[4]
    trial = LocalisationTrial()
    report = json.loads(json.dumps(trial.values(GOOD)))
    assert report["passed"] and report["trials"][0]["right"] and len(report["trials"]) == 30
    assert json.loads(json.dumps(trial.values(trial.from_values(report)))) == report


@pytest.mark.parametrize(("took", "said"), [
    (None, "not found"), (5.0, "found after 5.0 s, at"), (70.0, "70.0 s, too late")])
def test_a_trial_on_one_line(took, said):
    assert said in replace(TRIALS[0], took=took).line


def test_the_drives_on_one_line():
    assert TRACKING.line == "tracking: 3.0 cm, 1.0° off in the mean"
    assert LOAD.line == "load: 6 % of a core"


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


def test_a_scan_that_comes_late_does_not_set_it_going_again(monkeypatch):
    """The callback may be at work when nobody listens any more."""
    takes, speeds = [], []
    publisher = SimpleNamespace(publish=lambda command: speeds.append(command.linear.x))
    monkeypatch.setattr(localisation_drive.rospy, "Publisher", lambda *_, **__: publisher)
    monkeypatch.setattr(localisation_drive.rospy, "Subscriber", lambda _topic, _kind, take, **_: (
        takes.append(take), SimpleNamespace(unregister=lambda: None))[1])
    scan = LaserScan(angle_min=0.0, angle_increment=np.radians(1.0), range_min=0.1, range_max=3.5,
                     ranges=[3.0] * 360)
    with localisation_drive.wandering(0, lambda: True):
        takes[0](scan)
    assert speeds == [SPEED, 0.0]
    takes[0](scan)
    assert speeds[-1] == 0.0


def test_nothing_to_try_names_all_four():
    with pytest.raises(RunError, match="no starts, no kidnaps, no tracking and no load"):
        LocalisationTrial().parse(["--starts=0", "--kidnaps=0", "--tracking=0", "--load=0"])
