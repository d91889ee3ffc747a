"""One lap of the race trials: its disturbance, its light, and the run of the course it becomes."""

import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
import rospkg
from racecar_description.track.closed_line import load_track

from evaluation import race_trials as trial_module
from evaluation.course_run import CourseRun
from evaluation.lap import RACE, Disturbance, draw
from evaluation.race_trials import Lap, racetrack, random_track
from evaluation.trial import Case
from run_session.failure import RunError
from run_session.session import Session

CALM = Disturbance(0.0, 0.0, 0.0, 0.0, 1.0)
PACKAGES = rospkg.RosPack()


# --- what is drawn


def test_a_seed_is_always_the_same_disturbance():
    assert draw(3, RACE) == draw(3, RACE)
    assert draw(3, RACE) != draw(4, RACE)


def test_disturbances_fill_their_bounds():
    found = [draw(seed, RACE) for seed in range(400)]
    bounds = {"sideways": (-0.2, 0.2), "along": (-0.2, 0.2), "camera_noise": RACE.camera_noise,
              "light": RACE.light, "turn": (-math.radians(10), math.radians(10))}
    for name, (low, high) in bounds.items():
        values = [getattr(each, name) for each in found]
        tenth = (high - low) / 10
        assert low <= min(values) < low + tenth and high - tenth < max(values) <= high


def test_the_start_is_beside_and_along_the_line():
    track = load_track(racetrack().track)
    x, y, yaw = replace(CALM, sideways=0.1, along=-0.2, turn=0.15).start(track)
    found = track.nearest(x, y)
    assert found.lateral == pytest.approx(0.1)
    assert found.s == pytest.approx(track.length - 0.2)
    assert yaw == pytest.approx(track.pose(-0.2)[2] + 0.15)


# --- one lap


def test_the_course_run_of_a_lap_is_one_that_course_run_and_the_launch_file_know():
    case = Case("a lap", trial_module.RACETRACK, 5, "lane_follow.py")
    words = trial_module.RaceTrial().outing(Path("/o"), case).arguments(5, Path("/w.world"))
    found = CourseRun.parse(words)
    assert (found.fast, found.video, found.seed, found.camera) == (True, False, 5, None)
    assert found.any_port  # of a batch, which no other terminal joins
    assert found.track == racetrack().track
    package, file = found.launch
    launch = ElementTree.parse(Path(PACKAGES.get_path(package)) / "launch" / file).getroot()
    known = {element.get("name") for element in launch.findall("arg")}
    given = dict(argument.split(":=") for argument in found.launch_args)
    assert set(given) <= known
    assert given["world_name"] == "/w.world"
    assert float(given["camera_noise"]) == pytest.approx(draw(5, RACE).camera_noise, abs=1e-6)


def test_the_launch_file_hands_the_noise_to_the_camera():
    command = ["roslaunch", "--dump-params", "racecar_description", "race.launch",
               "camera_noise:=0.0123"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert "<stddev>0.0123</stddev>" in done.stdout


def stand_in(monkeypatch, code: int, report: dict | None = None, says: str = "") -> None:
    """A course_run that writes this report, says this, and ends so."""
    text = "import json, pathlib, sys; out = pathlib.Path(sys.argv[sys.argv.index('--out') + 1]);"
    if report is not None:
        text += f"(out / 'report.json').write_text(json.dumps({report!r}));"
    script = f"{text} print({says!r}); sys.exit({code})"
    run_drive = Session.drive

    def run(session, command, folder, *rest):
        out = command[command.index("--out"):]
        return run_drive(session, [sys.executable, "-c", script, *out], folder, *rest)

    monkeypatch.setattr(Session, "drive", run)


def drive(out: Path, follower: str = "lane_follow.py") -> Lap:
    """One lap on the racetrack, of seed 4."""
    case = Case(f"{follower} racetrack 4", "racetrack", 4, follower)
    with Session(out) as session:
        trial = trial_module.RaceTrial()
        return trial.judge(trial.drive(session, case))


REPORT = {
    "follower": "lane_follow.py", "outcome": "closed", "why": None, "distance_m": 37.0,
    "simulated_s": 20.0, "rms_lateral_m": 0.02, "max_lateral_m": 0.2,
    "frames_dropped": 0,
    "laps": [{"time_s": 18.0, "distance_m": 36.0, "rms_lateral_m": 0.01, "max_lateral_m": 0.1}],
}


def test_a_lap_is_what_course_run_reports(tmp_path, monkeypatch):
    stand_in(monkeypatch, 0, REPORT)
    found = drive(tmp_path)
    assert (found.outcome, found.time, found.mean_speed) == ("closed", 18.0, 2.0)
    assert found.rms_lateral == 0.02  # of the whole drive
    assert (found.set, found.seed, found.disturbance) == ("racetrack", 4, draw(4, RACE))
    assert found.folder == "laps/racetrack-4/lane_follow"


def test_a_lap_that_was_not_closed_is_a_lap_too(tmp_path, monkeypatch):
    left = REPORT | {"laps": [], "outcome": "left the course", "why": "at x=1"}
    stand_in(monkeypatch, 1, left)
    found = drive(tmp_path)
    assert (found.closed, found.within_limits, found.time) == (False, False, None)
    assert found.mean_speed == pytest.approx(37 / 20)


def test_a_lap_that_could_not_be_driven_is_an_error_that_says_which_and_why(tmp_path, monkeypatch):
    stand_in(monkeypatch, 2, says="before\ncourse_run: no follower 'x.py'")
    with pytest.raises(RunError, match=r"x\.py on racetrack, seed 4: course_run: no fol") as raised:
        drive(tmp_path, "x.py")
    assert raised.value.details == "before"


def test_an_old_report_is_no_result(tmp_path, monkeypatch):
    folder = tmp_path / "laps" / "racetrack-4" / "lane_follow"
    folder.mkdir(parents=True)
    (folder / "report.json").write_text(json.dumps(REPORT))
    stand_in(monkeypatch, 0)
    with pytest.raises(RunError):
        drive(tmp_path)


def test_a_random_track_is_one_to_drive_on(tmp_path):
    venue = random_track(101, tmp_path)
    assert load_track(venue.track).length > 10
    assert venue.world.is_file() and (venue.models / "random_101" / "model.sdf").is_file()
