"""The race trials without driving: command line, tables, pictures, exit codes, Ctrl-C."""

import importlib
import json
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from evaluation.command_line import INTERRUPTED, NOT_PASSED, NOT_RUN, PASSED
from evaluation.lap import RACE, Disturbance, draw
from evaluation.race_trials import (
    Lap,
    RaceTrial,
    summarize,
    write_path_sheet,
)
from evaluation.trial import run_trial
from run_session.failure import RunError

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "race_trials.py"
CALM = Disturbance(0.0, 0.0, 0.0, 0.0, 1.0)


def lap(seed=0, follower="lane_follow.py", **changes) -> Lap:
    """A good lap, or one that differs in this."""
    usual = Lap(
        follower=follower, set="racetrack", track="racetrack", seed=seed, outcome="closed",
        why=None, time=18.0, mean_speed=2.0, rms_lateral=0.01, max_lateral=0.2, frames_dropped=0,
        disturbance=CALM, folder="nowhere")
    return replace(usual, **changes)


# --- options


def test_seeds_and_tracks_that_are_asked_for():
    trial = RaceTrial()
    found = trial.cases(trial.parse(["--seeds", "3", "--first-seed", "7", "--tracks", "2"]))
    assert [each.seed for each in found[::2]] == [7, 8, 9, 101, 102]
    assert [each.driver for each in found[:2]] == ["lane_follow.py", "lane_follow_p.py"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--seeds", "many"], "--seeds (SEEDS=) must be a whole number"),
        (["--first-seed", "-1"], "--first-seed"),
        (["--tracks", "1.5"], "--tracks"),
        (["--seeds", "0", "--tracks", "0"], "nothing to drive"),
        (["--quick"], "--quick"),
        (["--out", "/proc/none"], "--out /proc/none: No such file or directory"),
    ],
)
def test_a_mistake_on_the_command_line_is_one_line(arguments, said, capsys):
    assert run_trial(RaceTrial(), arguments) == NOT_RUN
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert said in line


# --- results


@pytest.mark.parametrize(
    ("changes", "good"),
    [
        ({"rms_lateral": Lap.most_rms, "mean_speed": Lap.least_speed}, True),
        ({"rms_lateral": Lap.most_rms + 1e-4}, False),
        ({"mean_speed": Lap.least_speed - 1e-3}, False),
        ({"outcome": "stalled", "time": None}, False),
    ],
)
def test_limits(changes, good):
    assert lap(**changes).within_limits is good


def test_a_summary_is_of_one_follower_on_one_set():
    left = lap(2, outcome="left the course", time=None, rms_lateral=0.005, mean_speed=9.0)
    laps = [lap(0, rms_lateral=0.04), lap(1, mean_speed=1.0), left, lap(3, "lane_follow_p.py"),
            lap(101, set="random tracks")]
    ours, other_set, plain = sorted(
        summarize(laps), key=lambda each: (each["follower"], -each["laps"]))
    assert [ours[key] for key in ("laps", "closed", "within_limits", "worst_seed")] == [3, 2, 1, 2]
    assert (ours["mean_speed"], ours["least_speed"]) == (pytest.approx(1.5), 1.0)
    assert ours["mean_rms_lateral"] == pytest.approx(0.025) and ours["max_rms_lateral"] == 0.04
    assert (other_set["set"], plain["follower"]) == ("random tracks", "lane_follow_p.py")
    rows = RaceTrial().table(laps).splitlines()
    assert len(rows) == 4 and "2 of 3" in rows[1]


def test_the_table_of_a_follower_that_closed_nothing():
    assert "0 of 1" in RaceTrial().table([lap(outcome="stalled", time=None)])


@pytest.mark.parametrize("closed", [0, 1, 7])
def test_pictures_are_drawn_of_what_there_is(tmp_path, closed):
    chart = importlib.import_module("evaluation.race_trials")
    stalled = lap(9, outcome="stalled", time=None, set="random tracks")
    laps = [lap(seed, folder=".") for seed in range(closed)] + [stalled]
    cv2.imwrite(str(tmp_path / "path.png"), np.full((400, 500, 3), 255, np.uint8))
    chart.write_chart(laps, tmp_path / "trials.png")
    for path in (tmp_path / "trials.png", write_path_sheet(laps, tmp_path)):
        assert cv2.imread(str(path)) is not None


# --- from beginning to end


def trials(tmp_path, monkeypatch, laps, *options: str) -> int:
    """The program with these laps instead of driven ones; an exception among them is raised."""
    given = iter(laps)

    class Driven(RaceTrial):
        def drive(self, _session, case):
            found = next(given)
            if isinstance(found, BaseException):
                raise found
            return case, found

        def judge(self, record):
            case, found = record
            return replace(found, set=case.set, seed=case.seed, follower=case.driver,
                           disturbance=draw(case.seed, RACE))

    return run_trial(Driven(), ["--tracks", "0", "--out", str(tmp_path / "out"), *options])


def test_the_first_follower_decides(tmp_path, monkeypatch, capsys):
    bad = lap(outcome="left the course", time=None)
    assert trials(tmp_path, monkeypatch, [lap(), bad], "--seeds", "1") == PASSED
    assert trials(tmp_path, monkeypatch, [bad, lap()], "--seeds", "1") == NOT_PASSED
    assert "[1/2] lane_follow.py racetrack seed 0" in capsys.readouterr().out
    values = json.loads((tmp_path / "out" / "report.json").read_text())
    assert [each["within_limits"] for each in values["laps"]] == [False, True]
    assert values["laps"][0]["disturbance"]["light"] == draw(0, RACE).light
    assert (tmp_path / "out" / "paths_lane_follow_p.png").exists()


@pytest.mark.parametrize(
    ("end", "code", "said"),
    [
        (RunError("the machine broke"), NOT_RUN, "race_trials: the machine broke"),
        (KeyboardInterrupt(), INTERRUPTED, "3 of 4 cases are done; --resume goes on with the others"
         "\nrace_trials: interrupted; all processes ended"),
    ],
)
def test_what_was_driven_is_kept(tmp_path, monkeypatch, capsys, end, code, said):
    assert trials(tmp_path, monkeypatch, [lap(), lap(), lap(), end], "--seeds", "2") == code
    shown = capsys.readouterr()
    assert shown.err.strip() == said
    assert "1 of 1" in shown.out  # the table
    assert len(json.loads((tmp_path / "out" / "report.json").read_text())["laps"]) == 3
    assert (tmp_path / "out" / "trials.png").exists()


def test_a_run_goes_on_where_it_ended(tmp_path, monkeypatch, capsys):
    broken = [lap(mean_speed=1.7), RunError("broken")]
    assert trials(tmp_path, monkeypatch, broken, "--seeds", "2") == NOT_RUN
    capsys.readouterr()
    rest = [lap(), lap(), lap()]
    assert trials(tmp_path, monkeypatch, rest, "--seeds", "2", "--resume") == PASSED
    assert "[1/4]" not in (shown := capsys.readouterr().out) and "[2/4]" in shown
    values = json.loads((tmp_path / "out" / "report.json").read_text())
    found = RaceTrial().from_values(values)
    assert [each.mean_speed for each in found] == [1.7, 2.0, 2.0, 2.0]
    assert [(each.seed, each.disturbance) for each in found[1:3]] == [
        (seed, draw(seed, RACE)) for seed in (0, 1)]


@pytest.mark.parametrize(("text", "said"), [(None, "nothing to go on with"), ("{}", "no report"),
                                            ('{"laps": [{}]}', "no report")])
def test_no_report_to_go_on_with_is_said(tmp_path, monkeypatch, capsys, text, said):
    (tmp_path / "out").mkdir()
    if text:
        (tmp_path / "out" / "report.json").write_text(text)
    assert trials(tmp_path, monkeypatch, [], "--resume") == NOT_RUN
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert said in line


def left_running(out: Path) -> list[Path]:
    """Processes below the run: roscore and roslaunch hand their log folder down."""
    needle = f"ROS_LOG_DIR={out}/".encode()
    found = []
    for environ in Path("/proc").glob("[0-9]*/environ"):
        try:
            found += [environ] if needle in environ.read_bytes() else []
        except OSError:
            continue
    return found


@pytest.mark.timeout(240)
def test_interrupted_while_a_lap_runs_it_leaves_no_process_behind(tmp_path):
    out = tmp_path / "out"
    command = [sys.executable, str(SCRIPT), "--seeds", "1", "--tracks", "0", "--out", str(out)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
        until = time.monotonic() + 120
        while not left_running(out) and run.poll() is None and time.monotonic() < until:
            time.sleep(0.05)
        assert left_running(out)
        run.send_signal(signal.SIGINT)
        said = run.communicate(timeout=60)[1]
    assert run.returncode == INTERRUPTED
    assert said.strip() == "race_trials: interrupted; all processes ended"
    assert left_running(out) == []
