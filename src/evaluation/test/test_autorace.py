"""AutoRace's trial: the judge on made-up drives, and one mission in the real simulator."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from evaluation.autorace import RaceTrial
from evaluation.autorace_judge import WAY, Sample, score
from run_session.failure import RunError

SCRIPT = Path(__file__).parent.parent / "scripts" / "autorace.py"
UP, GREEN = frozenset({"traffic_bar_up"}), frozenset({"traffic_light_green"})


def drive(*ends, shown=UP | GREEN, begin=0.0, speed=0.5):
    """Samples at 20 Hz along straight lines, m; ("stand", s) stays where it is."""
    samples, time, place = [], begin, ends[0]
    for end in ends[1:]:
        stands = end[0] == "stand"
        to = place if stands else end
        steps = max(1, round(20 * (end[1] if stands else math.dist(place, to) / speed)))
        for step in range(steps):
            share = step / steps
            samples.append(Sample(time, place[0] + (to[0] - place[0]) * share,
                                  place[1] + (to[1] - place[1]) * share, shown))
            time += 0.05
        place = to
    return samples


def why(samples, mission, contacts=()):
    (found,) = score(samples, dict.fromkeys(contacts, 1.0), [mission])
    assert found.passed == (found.why is None)
    return found.why


def test_the_lane():
    way = [place for place in WAY if place[1] > -1.8][::3]
    whole = drive((0.8, -1.747), *way[2:], (-1.72, 0.05))
    assert why(whole, "lane") is None
    assert why(whole[:200], "lane") == "did not come to its end"
    aside = [*whole[:100], Sample(99.0, 1.0, -1.5), *whole[100:]]
    assert why(aside, "lane") == "left the lane at 1.00, -1.50"
    assert why([*whole, Sample(100.0, 0.5, -1.3)], "lane") is None  # the bar's mission by then
    assert why(whole, "lane", ["barrier_2", "tunnel_wall"]) == "touched barrier_2"


@pytest.mark.parametrize("shown, passed", [
    (GREEN, True), (frozenset({"traffic_light_red"}), False), (frozenset(), False)])
def test_the_light(shown, passed):
    samples = drive((0.8, -1.747), (1.5, -1.747), shown=shown)
    assert (why(samples, "traffic_light") is None) == passed
    assert why(samples[:5], "traffic_light") == "did not come to the light"


def test_the_bar():
    assert why(drive((-1.72, 1.0), (-1.72, 0.2)), "bar") is None
    closed = drive((-1.72, 1.0), (-1.72, 0.2), shown=frozenset({"traffic_bar_down"}))
    assert why(closed, "bar") == "did not wait for the bar"
    assert why(closed, "bar", ["traffic_bar_down"]) == "touched traffic_bar_down"
    assert why(drive((-1.72, 1.0), (-1.72, 0.8)), "bar") == "did not come to the bar"


def test_parking():
    way_in, way_out = ((1.0, 1.747), (0.48, 1.747), (0.48, 0.8), (0.755, 0.8)), (
        (0.48, 0.8), (0.48, 1.747), (0.0, 1.747))
    assert why(drive(*way_in, ("stand", 1.5), *way_out), "parking") is None
    assert why(drive(*way_in, ("stand", 0.5), *way_out), "parking") == "stood in no bay"
    twice = *way_in, ("stand", 0.6), (0.7, 0.8), ("stand", 0.6), *way_out
    assert why(drive(*twice), "parking") == "stood in no bay"
    assert why(drive(*way_in, ("stand", 1.5)), "parking") == "did not come back to the lane"


def test_tunnel_and_finish():
    way = (-1.72, 0.3), (-1.72, -1.7), (0.2, -1.747)
    assert why(drive(*way), "tunnel") is None
    assert why(drive(*way[:2]), "tunnel") == "did not find the exit"
    assert why(drive(*way, (0.8, -1.747), ("stand", 1.0)), "finish") is None
    assert why(drive(*way, (1.2, -1.747)), "finish") == "did not stop at the red line"


def test_a_mistyped_mission_is_one_line():
    with pytest.raises(RunError, match="there are: lane, traffic_light, "):
        RaceTrial().parse(["--mission", "bars"])
    with pytest.raises(RunError, match=r"--seeds \(SEEDS=\) must be a whole number, 1 to"):
        RaceTrial().parse(["--seeds", "0"])


@pytest.mark.processes
@pytest.mark.timeout(270)
def test_the_light_is_waited_for_in_the_simulator(tmp_path):
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "--mission", "traffic_light", "--seeds", "1", "--out",
         str(tmp_path / "out")], capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stdout + done.stderr
    (drove,) = json.loads((tmp_path / "out" / "report.json").read_text())["drives"]
    assert [each["mission"] for each in drove["scores"]] == ["traffic_light"]
    assert drove["scores"][0]["contacts"] == [] and drove["time"] < 40.0
    assert (tmp_path / "out" / "autorace.png").stat().st_size > 10_000
    assert (tmp_path / "out/drives/traffic_light-0.html").stat().st_size > 1_000_000
