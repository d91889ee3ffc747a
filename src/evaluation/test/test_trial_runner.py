"""The runner of all trials, with a trial that needs no robot."""

import json
import pickle
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest

from bullet_sim import __version__
from evaluation.command_line import INTERRUPTED, NOT_PASSED, NOT_RUN, PASSED, results_folder
from evaluation.report import cell, table
from evaluation.trial import Case, Trial, from_json, run_trial
from run_session.failure import RunError


@dataclass(frozen=True)
class Square:
    """A result."""

    name: str
    value: int


class Squares(Trial):
    """Squares numbers; `fails` at one of them, and `most` is the largest good one."""

    program = "squares"
    does = "Square numbers."
    good = "no square is large"
    writes = "report.json"
    shared = ("of",)

    def __init__(self, fails=None, most=9):
        self.fails, self.most, self.tried = fails, most, []

    def add_options(self, parser):
        parser.add_whole("--numbers", 3, "how many")
        parser.add_argument("--of", default="numbers")

    def check(self, options):
        if options.numbers == 7:
            raise RunError("7 is not tried")

    def cases(self, options):
        return [Case(str(number)) for number in range(options.numbers)]

    def drive(self, session, case):
        (session.out / case.name).mkdir(exist_ok=True)
        if case.name == self.fails:
            raise RunError("the machine broke")
        self.tried.append(case.name)
        return case.name

    def judge(self, record):
        return Square(record, int(record)**2)

    def passed(self, results):
        return all(each.value <= self.most for each in results)

    def line(self, result):
        return f"{result.name} squared is {result.value}"

    def table(self, results):
        return table([("number", "square"), *((each.name, str(each.value)) for each in results)])

    def values(self, results):
        return {"squares": [asdict(each) for each in results]}

    def from_values(self, values):
        return [from_json(Square, each) for each in values["squares"]]

    def pictures(self, results, out):
        (out / "a&b.png").write_bytes(b"")
        return ["a&b.png"]


def names(out):
    return [each["name"] for each in json.loads((out / "report.json").read_text())["squares"]]


def test_all_cases_are_tried_and_written(tmp_path, capsys):
    assert run_trial(Squares(), ["--out", str(tmp_path / "a/b")]) == PASSED
    assert names(tmp_path / "a/b") == ["0", "1", "2"]
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "[1/3] 0 squared is 0" and "number  square" in said
    assert said[-1] == f"written to {tmp_path / 'a/b'}: report.json, report.html, a&b.png"
    page = (tmp_path / "a/b" / "report.html").read_text()
    assert '<img src="a&amp;b.png"' in page
    assert "2 squared is 4" in page and "number  square" in page


def test_results_that_are_not_good_are_exit_code_1(tmp_path):
    assert run_trial(Squares(most=3), ["--out", str(tmp_path)]) == NOT_PASSED


def test_what_was_tried_is_kept_and_resume_tries_the_rest(tmp_path, capsys):
    words = ["--numbers", "4", "--out", str(tmp_path)]
    assert run_trial(Squares(fails="2"), words) == NOT_RUN
    shown = capsys.readouterr()
    assert shown.err == "squares: the machine broke\n" and "number  square" in shown.out
    assert names(tmp_path) == ["0", "1"]
    rest = Squares()
    assert run_trial(rest, [*words, "--resume"]) == PASSED
    assert rest.tried == ["2", "3"] and names(tmp_path) == ["0", "1", "2", "3"]
    assert "[3/4]" in capsys.readouterr().out


@pytest.mark.parametrize(("at", "says"), [
    ("2", "2 of 4 cases are done; --resume goes on with the others\n"), ("0", "")])
def test_ctrl_c_says_how_to_go_on(tmp_path, capsys, at, says):
    class Interrupted(Squares):
        def judge(self, record):
            if record == at:
                raise KeyboardInterrupt
            return super().judge(record)

    (tmp_path / "report.json").write_text('{"squares": [{"name": "8", "value": 64}]}')  # of no case
    words = ["--numbers", "4", "--out", str(tmp_path), "--resume"]
    assert run_trial(Interrupted(), words) == INTERRUPTED
    assert capsys.readouterr().err == f"{says}squares: interrupted; all processes ended\n"


CUT_OFF = """
import sys
from test_trial_runner import *

class Interrupted(Squares):
    def judge(self, record):
        if record == "2" and sys.stdin.read() == "":
            raise KeyboardInterrupt
        return super().judge(record)

sys.exit(run_trial(Interrupted(), ["--numbers", "4", "--out", sys.argv[1]]))
"""


@pytest.mark.processes
def test_ctrl_c_that_ends_tee_too_loses_no_page(tmp_path):
    run = subprocess.Popen([sys.executable, "-c", CUT_OFF, str(tmp_path)], text=True,
                           cwd=Path(__file__).parent, stdin=subprocess.PIPE,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    run.stdout.readline()
    run.stdout.close()
    run.stdin.close()
    assert run.wait(60) == INTERRUPTED
    assert (tmp_path / "report.html").exists()


@pytest.mark.parametrize(("words", "said"), [
    (["--numbers", "x"], "--numbers (NUMBERS=) must be a whole number, 0 to 999999; got 'x'"),
    (["--numbers", "7"], "7 is not tried"),
    (["--number", "1"], "rosrun evaluation squares.py --help"),
    (["--resume"], "nothing to go on with"),
    (["--out", "/proc/none"], "--out /proc/none: No such file or directory"),
])
def test_a_mistake_is_one_line(tmp_path, capsys, words, said):
    assert run_trial(Squares(), ["--out", str(tmp_path), *words]) == NOT_RUN
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert said in line


def test_results_of_other_options_are_not_mixed_with_those_that_there_are(tmp_path, capsys):
    words = ["--out", str(tmp_path)]
    assert run_trial(Squares(), [*words, "--numbers", "1", "--of", "primes"]) == PASSED
    before = (tmp_path / "report.json").read_text()
    assert run_trial(Squares(), [*words, "--resume"]) == NOT_RUN
    said = f"squares: {tmp_path}/report.json: is of --of primes; give that again, or another --out"
    assert capsys.readouterr().err.strip() == said
    assert (tmp_path / "report.json").read_text() == before
    assert run_trial(Squares(), [*words, "--resume", "--of", "primes"]) == PASSED


@pytest.mark.parametrize("text", [
    "{}", "[", "[]", '{"options": []}', '{"options": {"other": ""}}', '{"squares": [{}]}',
    '{"squares": [{"name": "1", "value": "one"}]}'])
def test_a_report_of_something_else_is_refused(tmp_path, capsys, text):
    (tmp_path / "report.json").write_text(text)
    assert run_trial(Squares(), ["--resume", "--out", str(tmp_path)]) == NOT_RUN
    assert "no report of squares" in capsys.readouterr().err


def test_the_columns_of_a_table():
    assert table([("a", "long head"), ("name", "1.0")]) == "a     long head\nname        1.0"
    assert (cell(0.123, 100, 1), cell(None)) == ("12.3", "-")


@pytest.mark.parametrize(("rows", "shown"), [
    ([("student", " points"), ("works", "1.0")], "学生    得分\nworks    1.0"),
    ([("student", "no word"), ("works", "1.0")], "student  no word\nworks        1.0")])
def test_a_table_is_in_one_language_and_names_stay(monkeypatch, rows, shown):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    assert table(rows, names=(0,)) == shown


def test_cases_can_be_sent_to_another_process():
    from evaluation.lane_trials import LaneTrial
    from evaluation.localisation_trials import LocalisationTrial
    from evaluation.navigation_trials import YardTrial
    from evaluation.race_trials import RaceTrial
    from evaluation.track_trials import TrackTrial

    for trial in (LaneTrial(), LocalisationTrial(), RaceTrial(), TrackTrial(), YardTrial()):
        cases = trial.cases(trial.parse([]))
        assert pickle.loads(pickle.dumps(cases)) == cases
        assert len({case.name for case in cases}) == len(cases)


def test_the_program_and_its_report_say_the_version(tmp_path, capsys):
    with pytest.raises(SystemExit):
        run_trial(Squares(), ["--version"])
    assert capsys.readouterr().out == f"squares.py {__version__}\n"
    run_trial(Squares(), ["--out", str(tmp_path)])
    assert json.loads((tmp_path / "report.json").read_text())["version"] == __version__


def test_a_folder_that_another_run_writes_is_refused(tmp_path, capsys):
    trial = Squares()
    with results_folder("squares", tmp_path):
        assert run_trial(trial, ["--out", str(tmp_path)]) == NOT_RUN
    assert trial.tried == [] and "is being written by another run" in capsys.readouterr().err
    assert run_trial(trial, ["--out", str(tmp_path)]) == PASSED
