"""`make soak`: what counts as growth, and one short run."""

import csv
import itertools
import math
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from evaluation.command_line import run_program
from run_session.failure import RunError
from run_session.processes import Process

sys.path.insert(0, str(Path(__file__).parent / "soak"))
import samples
import soak
from growth import judge
from samples import ALL, CLOCK, FEWEST, PERIOD, Sample

PROGRAM = Path(__file__).parent / "soak" / "soak.py"
HOUR = 3600.0


def hours(count, memory=lambda _: 100.0, descriptors=lambda _: 20, pace=lambda _: 1.0,
          speed=lambda _: 0.05):
    """Samples of a process and the clock; each figure is a function of the time, s."""
    found = []
    for now in (number * PERIOD for number in range(int(count * HOUR / PERIOD))):
        found.append(Sample(now, CLOCK, 0.0, 0, 0, pace(now), 100.0, speed(now)))
        found.append(Sample(now, "gazebo", memory(now), descriptors(now), 12, 0.0, 0.0, 0.0))
    return found


@pytest.mark.parametrize(("figures", "changed"), [
    ({}, []),
    ({"memory": lambda time: min(50.0 + time, 300.0)}, []),  # flat after ten minutes
    ({"memory": lambda time: 100.0 + time / HOUR}, []),  # 1 MiB an hour is below the least
    ({"memory": lambda time: 100.0 + 5 * time / HOUR}, ["gazebo memory"]),
    ({"memory": lambda time: 100.0 - 5 * time / HOUR}, []),
    ({"descriptors": lambda time: 20 + int(time // 600)}, ["gazebo descriptors"]),
    ({"pace": lambda time: 1.0 - 0.05 * time / HOUR}, ["clock pace"]),
    ({"pace": lambda _: 0.0}, ["clock pace"]),  # it stands still
    ({"speed": lambda time: 0.05 * (time < HOUR)}, ["clock speed"]),
    ({"speed": lambda time: 0.4 * (time % 60 < PERIOD)}, []),  # a goal a minute
    ({"speed": lambda _: 0.003}, ["clock speed"]),  # trembles, or slides
    ({"speed": lambda _: math.nan}, ["clock speed"]),
])
def test_growth_is_more_than_two_percent_after_the_warm_up(figures, changed):
    table, verdict = judge(hours(1.5, **figures))
    rows = [" ".join(line.split()[:2]) for line in table.splitlines()
            if line.endswith(("CHANGES", "STANDS"))]
    assert rows == changed and verdict is bool(changed)


@pytest.mark.parametrize(("seconds", "speed", "stands"), [
    (25.0, lambda _: 0.18, False),
    (25.0, lambda _: 0.0, True),
    (220.0, lambda time: 0.2 * (time % 60 < 2 * PERIOD), False),  # rests at the end
    (220.0, lambda time: 0.2 * (time < 100), True),
])
def test_a_short_run_tells_driving_from_standing(seconds, speed, stands):
    period = min(PERIOD, seconds / FEWEST)
    times = [period * number for number in range(1, round(seconds / period) + 1)]
    found = [Sample(time, CLOCK, 0.0, 0, 0, 1.0, 100.0, speed(time)) for time in times]
    table, verdict = judge(found)
    assert ("STANDS" in table) is verdict is stands


@pytest.mark.parametrize("count", [0.0, 5 * PERIOD / HOUR])
def test_too_few_samples_are_no_verdict(count):
    with pytest.raises(RunError, match="too few samples"):
        judge(hours(count))


def test_ever_more_processes_of_other_names_are_growth(monkeypatch):
    monkeypatch.setattr(samples.rospy, "Subscriber", lambda *_, **__: None)
    now = itertools.count(0.0, PERIOD)
    monkeypatch.setattr(samples.rospy, "get_time", lambda: 0.0)
    monkeypatch.setattr(samples, "time", SimpleNamespace(monotonic=lambda: next(now)))
    monkeypatch.setattr(samples, "processes", lambda: left)
    monkeypatch.setattr(samples, "_place", lambda _: (0.0, 0.0))
    sampler, left, found = samples.Sampler("robot"), [], []
    for number in range(24):
        left.append(Process(os.getpid(), f"node{number}", 0.0, 1 << 20))
        found += sampler.look()
    changed = [line.split()[:2] for line in judge(found)[0].splitlines() if "CHANGES" in line]
    assert [["all", kind] for kind in ("memory", "descriptors", "threads")] == [
        row for row in changed if row[0] == "all"]


@pytest.mark.processes
def test_a_short_run_is_sampled_and_leaves_its_files(tmp_path):
    run = subprocess.run([sys.executable, str(PROGRAM), "--hours", "0.007"],
                         capture_output=True, text=True, timeout=240, check=False)
    assert run.returncode in (0, 1) and not run.stderr, run.stdout + run.stderr
    out = Path(run.stdout.strip().splitlines()[-1].split()[2].rstrip(":"))
    with (out / "samples.csv").open(encoding="utf-8") as file:
        names = {row["name"] for row in csv.DictReader(file)}
    assert {CLOCK, ALL, "gazebo", "follower", "sim_viewer", "rosmaster"} <= names
    assert "STANDS" not in run.stdout
    assert (out / "growth.png").stat().st_size > 10_000


@pytest.mark.parametrize("words", [["--hours", "0"], ["--hours", "nan"], ["--course", "moon"]])
def test_a_mistake_is_said_and_nothing_starts(capsys, words):
    code = run_program("soak", lambda: soak.main(words))
    said = capsys.readouterr().err
    assert code == 2 and said.count("\n") == 1 and words[1] in said
