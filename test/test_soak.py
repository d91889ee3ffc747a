"""`make soak`: what counts as growth, and one short run."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "soak"))
from growth import judge
from samples import CLOCK, PERIOD, Sample

PROGRAM = Path(__file__).parent / "soak" / "soak.py"
HOUR = 3600.0


def hours(count, memory=lambda _: 100.0, descriptors=lambda _: 20, pace=lambda _: 1.0):
    """Samples of a process and the clock; each figure is a function of the time, s."""
    found = []
    for time in (number * PERIOD for number in range(int(count * HOUR / PERIOD))):
        found.append(Sample(time, CLOCK, 0.0, 0, 0, pace(time), 100.0))
        found.append(Sample(time, "gazebo", memory(time), descriptors(time), 12, 0.0, 0.0))
    return found


@pytest.mark.parametrize(("figures", "changed"), [
    ({}, []),
    ({"memory": lambda time: min(50.0 + time, 300.0)}, []),  # flat after ten minutes
    ({"memory": lambda time: 100.0 + time / HOUR}, []),  # 1 MiB an hour is below the least
    ({"memory": lambda time: 100.0 + 5 * time / HOUR}, ["gazebo memory"]),
    ({"memory": lambda time: 100.0 - 5 * time / HOUR}, []),
    ({"descriptors": lambda time: 20 + int(time // 600)}, ["gazebo descriptors"]),
    ({"pace": lambda time: 1.0 - 0.05 * time / HOUR}, ["clock pace"]),
])
def test_growth_is_more_than_two_percent_after_the_warm_up(figures, changed):
    table, verdict = judge(hours(1.5, **figures))
    rows = [" ".join(line.split()[:2]) for line in table.splitlines() if line.endswith("CHANGES")]
    assert rows == changed and verdict is bool(changed)


@pytest.mark.processes
def test_a_short_run_is_sampled_and_leaves_its_files(tmp_path):
    run = subprocess.run([sys.executable, str(PROGRAM), "--hours", "0.007"],
                         capture_output=True, text=True, timeout=240, check=False)
    assert run.returncode in (0, 1) and not run.stderr, run.stdout + run.stderr
    out = Path(run.stdout.strip().splitlines()[-1].split()[2].rstrip(":"))
    with (out / "samples.csv").open(encoding="utf-8") as file:
        names = {row["name"] for row in csv.DictReader(file)}
    assert {CLOCK, "gazebo", "follower", "sim_viewer", "rosmaster"} <= names
    assert (out / "growth.png").stat().st_size > 10_000


@pytest.mark.parametrize("words", [["--hours", "0"], ["--hours", "nan"], ["--course", "moon"]])
def test_a_mistake_is_said_and_nothing_starts(words):
    run = subprocess.run([sys.executable, str(PROGRAM), *words],
                         capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 2 and words[0] in run.stderr.splitlines()[-1]
