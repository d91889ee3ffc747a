"""`make grade`: one submission's verdict, for a person, a CI job and its exit code."""

import dataclasses
import subprocess
import sys
import xml.etree.ElementTree as Xml
from pathlib import Path

import made_up
import pytest
from marking.grade import GradingTrial
from marking.points import Mark
from marking.submissions import digest

from evaluation.trial import run_trial
from run_session.failure import RunError

SCRIPT = Path(__file__).parents[1] / "scripts" / "grade.py"
LIMIT = 500.0  # s, wall


@pytest.fixture(autouse=True)
def _in_english(monkeypatch):
    monkeypatch.setenv("LANGUAGE", "en")


@pytest.fixture()
def grading(tmp_path):
    """A trial of one program on two seeds, whose pass line is 60 points."""
    (tmp_path / "follower.py").write_text(made_up.LESSON)
    trial = GradingTrial()
    trial.parse(["--file", str(tmp_path / "follower.py"), "--out", str(tmp_path / "out"),
                 "--seeds", "2", "--no-sandbox"])
    return trial


def marks_of(*points, outcome="closed", loss="-1: a <b> | `c`"):
    return [Mark(f"follower/0-{seed}", "follower", f"track0-seed{seed}", outcome, each, (loss,), "",
                 did="lap finished") for seed, each in enumerate(points, start=1)]


def junit(tmp_path):
    return Xml.parse(tmp_path / "out" / "junit.xml").getroot()


@pytest.mark.parametrize(("points", "passed", "failures", "verdict"), [
    ((100, 60.5), True, "0", "passed with 80.2 of 100 points, 60 are needed"),
    ((100, 20), True, "0", "passed with 60 of 100 points, 60 are needed"),
    ((95, 20), False, "1", "not passed: 57.5 of 100 points, 60 are needed")])
def test_the_mean_passes_and_junit_agrees(grading, tmp_path, points, passed, failures, verdict):
    marks = marks_of(*points)
    (tmp_path / "out").mkdir()
    grading.pictures(marks, tmp_path / "out")
    assert grading.passed(marks) is passed
    assert grading.table(marks) == verdict
    suites = junit(tmp_path)
    assert (suites.get("tests"), suites.get("failures"), suites.get("errors")) == (
        "2", failures, "0")
    assert [case.get("name") for case in suites.iter("testcase")] == [
        "track0-seed1", "track0-seed2"]
    for failure in suites.iter("failure"):
        assert failure.get("message") == "20 of 100: lap finished"
        assert failure.text == "-1: a <b> | `c`"
    lines = (tmp_path / "out" / "summary.md").read_text(encoding="utf-8").splitlines()
    assert lines[:3] == ["# follower", "", verdict]
    assert r"  - -1: a &lt;b&gt; \| \`c\`" in lines  # shown, not obeyed
    assert "These submissions ran without a sandbox." in lines


def test_a_course_that_could_not_be_run_is_no_mark(grading, tmp_path):
    marks = marks_of(100, outcome="not run")
    (tmp_path / "out").mkdir()
    grading.pictures(marks, tmp_path / "out")
    assert junit(tmp_path).get("errors") == "1"
    with pytest.raises(RunError, match="this is no mark"):
        grading.passed(marks)


def test_a_verdict_that_is_not_one_is_not_written(grading):
    assert grading.table(marks_of(100, outcome="not run")) == (
        "no mark: the course could not be run")


def test_just_below_the_pass_line_is_not_shown_as_on_it(grading):
    assert grading.table(marks_of(59.96)) == "not passed: 59.96 of 100 points, 60 are needed"


def test_marks_of_another_program_in_this_folder_do_not_count(grading, tmp_path):
    mine, other = marks_of(30.0), [dataclasses.replace(each, student="other", name="other/0-1")
                                   for each in marks_of(95.0)]
    mine = [dataclasses.replace(each, submission_sha256=digest(tmp_path / "follower.py"))
            for each in mine]
    assert grading.from_values(grading.values([*other, *mine])) == mine


def test_nobodys_program_runs_unprotected_as_root(tmp_path, monkeypatch):
    (tmp_path / "follower.py").write_text(made_up.LESSON)
    monkeypatch.setattr("os.getuid", lambda: 0)
    monkeypatch.setenv("SUDO_USER", "ann")
    monkeypatch.setattr("marking.grade.available", lambda: (_ for _ in ()).throw(
        RunError("no sandbox: not here; type this")))
    with pytest.raises(RunError, match="no sandbox"):
        GradingTrial().parse(["--file", str(tmp_path / "follower.py"),
                              "--out", str(tmp_path / "out")])


@pytest.mark.parametrize(("name", "content", "says"), [
    ("a.py", "", "a.py is empty"),
    ("a.py", "# mine\n", "a.py has only comments"),
    ("a.py", "x = 1\nprint 'x'\n", "exception in a.py, line 2: SyntaxError: Missing parentheses"),
    ("a.py", None, "No such file or directory"),
    ("folder", None, "there is no Python program in it"),
    ("a.docx", "x", "a.docx is not a Python file, a folder, a zip or a tar")])
def test_what_cannot_be_driven_is_one_line(tmp_path, capsys, name, content, says):
    path, out = tmp_path / name, tmp_path / "out"
    out.mkdir()
    (out / "junit.xml").write_text("earlier")
    if content is not None:
        path.write_text(content)
    elif name == "folder":
        path.mkdir()
    assert run_trial(GradingTrial(), ["--file", str(path), "--out", str(out)]) == 2
    [line] = "".join(capsys.readouterr()).splitlines()
    assert says in line
    if path.exists():  # a CI job shows it
        assert says in next(junit(tmp_path).iter("failure")).text
        assert says in (out / "summary.md").read_text()
    else:
        assert list(out.iterdir()) == []


@pytest.mark.processes
@pytest.mark.timeout(LIMIT)
def test_a_program_that_divides_by_zero_has_not_passed(tmp_path):
    program = made_up.LESSON.replace("command = Twist()", "command = Twist()\n        1 / 0", 1)
    (tmp_path / "follower.py").write_text(program)
    line = 1 + program[:program.index("1 / 0")].count("\n")
    rules = made_up.write_rules(tmp_path / "marking.yaml")
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "--file", str(tmp_path / "follower.py"), "--rules",
         str(rules), "--out", str(tmp_path / "out")], capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 1, done.stdout + done.stderr
    said = next(junit(tmp_path).iter("failure")).text
    assert said.startswith(
        f"-100: exception in follower.py, line {line}: ZeroDivisionError: division by zero; "
        "the car stalled at x=")
    assert "not passed: 0 of 100 points, 60 are needed" in done.stdout
    assert (tmp_path / "out/students/follower/track0-seed1.webp").stat().st_size > 1000
