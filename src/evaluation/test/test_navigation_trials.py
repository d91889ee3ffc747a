"""The navigation trials without driving: command line, tables, pictures, exit codes."""

import importlib
import json
from dataclasses import asdict, replace
from types import SimpleNamespace

import cv2
import pytest

from evaluation import navigation_trials as trial_module
from evaluation.command_line import NOT_PASSED, NOT_RUN, PASSED
from evaluation.navigation_trials import DriveResult, YardTrial, summarize, write_sheets
from evaluation.trial import run_trial
from evaluation.yard_drive import CROSSINGS, YARDS
from run_session.failure import RunError
from trial_worlds.crossing import draw_crossing
from trial_worlds.yard import draw_yard


def made(seed=0, repeat=0, **changes) -> DriveResult:
    """A good drive through a yard, or one that differs in this."""
    usual = DriveResult(
        YARDS, seed, repeat, "reached", None, 20.0, 4.5, 16.0, 17.0, 0.05, None, [], 0,
        1.0, asdict(draw_yard(seed).difficulty))
    return replace(usual, **changes)


def crossed(seed=0, **changes) -> DriveResult:
    """The same of one past a person."""
    return made(seed, **{"set": CROSSINGS, "to_obstacles": None, "to_person": 0.2,
                         "drawn": asdict(draw_crossing(seed)), **changes})


# --- command line


def test_yards_and_crossings_that_are_asked_for():
    trial = YardTrial()
    found = trial.parse(["--yards", "3", "--first-yard", "7", "--crossings", "0"])
    assert [(each.seed, each.repeat) for each in trial.cases(found)] == [
        (7, 0), (8, 0), (9, 0), (7, 1), (8, 1), (9, 1)]
    assert found.parameters.name == "yard.yaml"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--yards", "many"], "--yards (YARDS=) must be a whole number"),
        (["--first-crossing", "-1"], "--first-crossing"),
        (["--repeats", "0", "--crossings", "0"], "nothing to drive"),
        (["--real-time-factor", "0"], "--real-time-factor (PACE=) must be"),
        (["--parameters", "/none.yaml"], "--parameters /none.yaml: no such file"),
        (["--quick"], "--quick"),
        (["--out", "/proc/none"], "--out /proc/none: No such file or directory"),
    ],
)
def test_a_mistake_on_the_command_line_is_one_line(arguments, said, capsys):
    assert run_trial(YardTrial(), arguments) == NOT_RUN
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert said in line


# --- results


@pytest.mark.parametrize(
    ("drives", "good"),
    [
        ([made(n % 12, n // 12) for n in range(20)], True),
        ([made(n % 12, n // 12, outcome="late" if n == 0 else "reached") for n in range(20)], True),
        ([made(n, outcome="late" if n == 0 else "reached") for n in range(10)], False),
        ([made(), crossed(outcome="contact")], False),
        ([made(), crossed(outcome="walked into")], True),
        ([made(), crossed(outcome="late")], False),
        ([made(), *[crossed(n, outcome="late" if n == 0 else "reached") for n in range(20)]], True),
    ],
)
def test_limits(drives, good):
    assert YardTrial().passed(drives) is good


def test_scores_are_the_challenge_s():
    scores = [made(time=time).score for time in (17.0, 4 * 17.0, 6 * 17.0, 100 * 17.0)]
    assert scores == pytest.approx([0.25, 0.25, 1 / 6, 0.125])
    assert made(outcome="contact").score == 0.0


def test_a_summary_is_of_one_set_and_its_times_are_of_what_arrived():
    drives = [made(0), made(1, time=30.0, recoveries=["rotate"]),
              made(2, time=5.0, outcome="contact"), crossed(0)]
    yards, crossings = summarize(drives)
    assert (yards["drives"], yards["outcomes"]) == (3, {"contact": 1, "reached": 2})
    assert (yards["mean_time"], yards["mean_time_by_straight"]) == (25.0, 25 / 16)
    assert (yards["drives_with_recovery"], yards["failed"]) == (1, ["yards-2-0"])
    assert (crossings["least_to_person"], crossings["least_to_obstacles"]) == (0.2, None)
    shown = YardTrial().table(drives)
    assert "2 of 3" in shown and "67%" in shown
    assert "0 of 1" in YardTrial().table([made(outcome="late")])


def test_pictures_are_drawn_of_what_there_is(tmp_path):
    chart = importlib.import_module("evaluation.navigation_trials")
    drives = [made(0), made(0, 1, outcome="contact"), made(3, outcome="late"), crossed(2)]
    (tmp_path / "drives").mkdir()
    for each in drives[:2]:
        (tmp_path / "drives" / f"{each.name}.json").write_text("[[0, 0, 0, 0], [9, 1, 0.5, 0]]")
    chart.write_chart(drives, tmp_path / "trials.png")
    assert write_sheets(drives, tmp_path) == ["yards.png", "crossings.png"]
    for name in ("trials.png", "yards.png", "crossings.png"):
        assert cv2.imread(str(tmp_path / name)) is not None


# --- from beginning to end


def read_drives(out) -> list[DriveResult]:
    return YardTrial().from_values(json.loads((out / "report.json").read_text()))


@pytest.fixture
def trials(tmp_path, monkeypatch):
    """Runs main with these drives instead of driven ones; an exception among them is raised."""

    def run(drives, *options: str) -> int:
        given = iter(drives)

        def drive(_rig, _task):
            found = next(given)
            if isinstance(found, BaseException):
                raise found
            way = [(0.0, 0.0, 0.0, 0.0), (5.0, 1.0, 0.0, 0.0)]
            return SimpleNamespace(passage=SimpleNamespace(path=way), found=found)

        monkeypatch.setattr(trial_module, "NavigationStack", lambda *_, **__: None)
        monkeypatch.setattr(trial_module.yard_drive, "drive_task", drive)
        monkeypatch.setattr(trial_module, "judged", lambda record: record.found)
        return run_trial(YardTrial(), [*options, "--out", str(tmp_path)])

    return run


def test_all_is_driven_and_written(trials, tmp_path, capsys):
    drives = [made(0), made(1), made(0, 1), made(1, 1), crossed(0)]
    assert trials(drives, "--yards", "2", "--crossings", "1") == PASSED
    assert read_drives(tmp_path) == drives
    assert json.loads((tmp_path / "report.json").read_text())["passed"] is True
    assert len(list(tmp_path.glob("*.png"))) == 3
    assert (tmp_path / "worlds" / "yard_1.world").exists()
    assert "[5/5] crossings-0-0: reached" in capsys.readouterr().out


def test_what_was_driven_is_kept_and_resume_goes_on(trials, tmp_path, capsys):
    options = ("--yards", "2", "--repeats", "1", "--crossings", "0")
    assert trials([made(0), RunError("gazebo ended")], *options) == NOT_RUN
    assert len(read_drives(tmp_path)) == 1
    assert trials([made(1, outcome="late")], *options, "--resume") == NOT_PASSED
    assert [each.seed for each in read_drives(tmp_path)] == [0, 1]
    assert trials([], *options, "--resume") == NOT_PASSED
    assert "gazebo ended" in capsys.readouterr().err


def test_a_report_of_something_else_is_refused(tmp_path, capsys):
    (tmp_path / "report.json").write_text("{}")
    assert run_trial(YardTrial(), ["--resume", "--out", str(tmp_path)]) == NOT_RUN
    assert "no report of navigation_trials" in capsys.readouterr().err
