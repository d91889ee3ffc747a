"""Which drives a case takes, and which earlier marks stay, without a simulator."""

import json
import re
import shutil
from dataclasses import replace

import made_up
import pytest
from marking.bubblewrap import Kind
from marking.case_files import FILM, OUTPUT, PATH_PICTURE, THUMBNAIL, read_case
from marking.case_runner import BY_TIME
from marking.trial import TIMED, TRIES, MarkingTrial

from bullet_sim.description import SceneDescription
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.scene_text import scene_to_text
from evaluation.run_page import RECORDING, RUN_PAGE
from marking import trial as trial_module
from run_session.failure import RunError
from run_session.files import find_package
from run_session.session import StatusLine

CLOSED = {"outcome": "closed", "violations": [], "fault": "", "why": "", "exception": "",
          "laps_wanted": 1, "laps_closed": 1, "driven_share": 1.0, "rms_lateral_m": 0.03,
          "mean_speed_m_s": 0.2}
RECORDED = "".join(json.dumps(line) + "\n" for line in (
    {"scene": scene_to_text(Scene(SceneDescription()))}, {"names": ["car::base"]},
    *({"time": time, "poses": [[time, 0, 0, 0, 0, 0, 1]]} for time in (0.1, 0.2))))


class FakeSession:
    """Its drives bring these reports, or raise them; it keeps what each was asked to drive."""

    def __init__(self, *reports):
        self._reports, self.cases = iter(reports), []
        self.progress = StatusLine()

    def drive(self, _command, folder, _what, _limit, _environment):
        self.cases.append(read_case(folder))
        report = next(self._reports)
        if isinstance(report, Exception):
            raise report
        return report


@pytest.fixture()
def marking(tmp_path, monkeypatch):
    """A trial of one submission, and its options."""
    monkeypatch.setenv("LANGUAGE", "en")
    made_up.write(tmp_path / "in", {"good"})
    rules = made_up.write_rules(tmp_path / "marking.yaml")
    trial = MarkingTrial()
    return trial, trial.parse(["--submissions", str(tmp_path / "in"), "--rules", str(rules),
                               "--out", str(tmp_path / "out"), "--no-sandbox"])


def mark(marking, session):
    trial, options = marking
    [case] = trial.cases(options)
    return trial.judge(trial.drive(session, case))


def test_what_answers_each_image_drives_once(marking, capsys):
    session = FakeSession(CLOSED)
    found = mark(marking, session)
    trial, options = marking
    assert trial.pictures([found], options.out) == []
    begun, written = capsys.readouterr().out.splitlines()
    assert begun == "good: course, track 0, seed 1: driving, at most 1650 s"
    assert written.startswith(f"the marks: {options.out / 'marks.csv'}, ")
    assert (found.points, found.note) == (100, "")
    assert [case.timed for case in session.cases] == [False]


def test_what_a_drive_leaves_for_the_student_is_kept_once(marking):
    trial, options = marking
    [case] = trial.cases(options)
    record = trial.drive(FakeSession(CLOSED), case)
    folder = options.out / "cases" / "good" / "track0-seed1"
    (folder / RECORDING).write_text(RECORDED)
    for name in (PATH_PICTURE, THUMBNAIL, FILM):
        (folder / name).write_text(name)
    found = trial.judge(record)
    trial.pictures([found], options.out)
    kept = options.out / "students" / "good"
    assert {each.name for each in kept.iterdir()} == {
        "index.html", *(f"track0-seed1.{ending}" for ending in ("html", "mp4", "png", "webp"))}
    for each in kept.iterdir():  # a link on a page is a file in its folder
        linked = re.findall(r'(?:href|src)="([^"#:]+)"', each.read_text())
        assert all((kept / name).exists() for name in linked)
    assert not {each.name for each in folder.iterdir()} & {RUN_PAGE, PATH_PICTURE, THUMBNAIL, FILM}


def test_a_drive_shows_nothing_of_an_earlier_one(marking):
    trial, options = marking
    folder, kept = options.out / "cases/good/track0-seed1", options.out / "students/good"
    for each in (folder, kept):
        each.mkdir(parents=True)
    (folder / RECORDING).write_text(RECORDED)  # of a run that was killed
    for name in (PATH_PICTURE, THUMBNAIL, FILM, OUTPUT):
        (folder / name).write_text("earlier")
    for ending in ("html", "png", "webp", "mp4"):
        (kept / f"track0-seed1.{ending}").write_text("earlier")
    trial.pictures([mark(marking, FakeSession(*[RunError("no roscore")] * TRIES))], options.out)
    assert {each.name for each in kept.iterdir()} == {"index.html"}
    assert "earlier" not in (kept / "index.html").read_text()


@pytest.mark.parametrize("program, says", [
    ("", "good.py is empty"), (" \n", "good.py is empty"),
    ("# TODO\n", "good.py has only comments"),
    ("x = 1\0\n", "exception in good.py, line 1: SyntaxError: source code string cannot contain"),
    ("x = 1\nprint 'x'\n", "exception in good.py, line 2: SyntaxError: ")])
def test_a_program_without_code_is_not_driven(marking, tmp_path, capsys, program, says):
    (tmp_path / "in" / "good.py").write_text(program)
    trial, options = marking
    found = mark(marking, FakeSession())
    assert (found.points, found.outcome, found.folder) == (0, "fault", "")
    assert trial.line(found).startswith(f"good: 0 of 100: the program failed. -100: {says}")
    trial.pictures([found], options.out)
    assert "driving" not in capsys.readouterr().out
    assert f"-100: {says}" in json.dumps(trial.values([found]))
    assert says in (options.out / "marks.html").read_text()
    assert says in (options.out / "students" / "good" / "index.html").read_text()


@pytest.mark.parametrize("content", [
    "# 我的\nx = 1\n".encode("gbk"), "x = 1\n".encode("utf-16")])
def test_a_program_that_is_not_in_utf_8_is_not_driven(marking, tmp_path, content):
    (tmp_path / "in" / "good.py").write_bytes(content)
    found = mark(marking, FakeSession())
    assert (found.points, found.outcome) == (0, "fault")
    assert found.lost == ("-100: exception in good.py, line 1: SyntaxError: the file is not in "
                          "UTF-8, save it as UTF-8",)


@pytest.mark.parametrize("program", ["# mine\rx = 1\r", "\ufeffx = 1", "# mine\r\n\t\r\nx = 1"])
def test_a_program_with_a_line_of_code_is_driven(marking, tmp_path, program):
    (tmp_path / "in" / "good.py").write_bytes(program.encode())
    assert mark(marking, FakeSession(CLOSED)).outcome == "closed"


def test_the_line_names_all_losses(marking):
    trial, options = marking
    lost = ("-1.7: 3.8 cm off the line", "-5: 0.150 m/s on average")
    found = replace(mark(marking, FakeSession(CLOSED)), points=93.3, lost=lost)
    had = "93.3 of 100: lap finished. -1.7: 3.8 cm off the line. -5: 0.150 m/s on average"
    assert trial.line(found) == f"good: {had}"
    options.rules = replace(options.rules, seeds=2)
    assert trial.line(found) == f"good, track 0, seed 1: {had}"


def test_what_does_not_drives_again_in_real_time(marking, capsys):
    session = FakeSession({**CLOSED, "outcome": BY_TIME}, CLOSED)
    found = mark(marking, session)
    assert (found.points, found.note) == (100, TIMED)
    first, second = session.cases
    assert [line.rpartition(": ")[2] for line in capsys.readouterr().out.splitlines()] == [
        "driving, at most 1650 s", "driving in real time, at most 1650 s"]
    assert {"real_time_factor:=0", "lockstep_timeout:=5"} <= set(first.launch_args)
    assert {"real_time_factor:=1", "lockstep_timeout:=0.05"} <= set(second.launch_args)
    assert len(first.launch_args) == len(second.launch_args)


def test_a_course_that_did_not_come_up_is_tried_again(marking, capsys):
    session = FakeSession(RunError("no roscore"), CLOSED)
    assert mark(marking, session).points == 100
    assert "no roscore" in capsys.readouterr().out.splitlines()
    assert len(session.cases) == 2


def test_a_changed_submission_is_marked_again(marking, tmp_path, capsys):
    trial, options = marking
    found = mark(marking, FakeSession(CLOSED))
    capsys.readouterr()
    (options.out / "report.json").write_text(json.dumps(trial.values([found])))
    assert trial.earlier(options) == [found]
    (tmp_path / "in" / "good.py").write_text("changed")
    assert trial.earlier(options) == []
    assert capsys.readouterr().out == "good: the submission has changed, it is marked again\n"


def test_marks_of_other_tracks_or_without_the_sandbox_are_not_gone_on_with(
        marking, tmp_path, monkeypatch):
    trial, options = marking
    (options.out / "report.json").parent.mkdir(exist_ok=True)
    (options.out / "report.json").write_text(json.dumps(trial.values([])))
    monkeypatch.setattr(trial_module, "available", lambda: Kind.USER)
    words = ["--submissions", str(tmp_path / "in"), "--out", str(tmp_path / "out"), "--rules"]
    boxed = MarkingTrial()
    boxed.parse([*words, str(tmp_path / "marking.yaml")])
    with pytest.raises(RunError, match="was marked without a sandbox, this run is in a sandbox"):
        boxed.earlier(options)


def test_a_changed_track_is_another_rule(tmp_path):
    made_up.write(tmp_path / "in", {"good"})
    track = tmp_path / "track.yaml"
    shutil.copy(find_package("racecar_description") / "tracks" / "racetrack.yaml", track)
    rules = made_up.write_rules(tmp_path / "marking.yaml")
    rules.write_text(re.sub(r"(?m)^tracks:.*", "tracks: [track.yaml]", rules.read_text()))
    words = ["--submissions", str(tmp_path / "in"), "--rules", str(rules), "--out",
             str(tmp_path / "out"), "--no-sandbox"]
    first, second = MarkingTrial(), MarkingTrial()
    first.parse(words)
    track.write_text(track.read_text() + "# changed\n")
    options = second.parse(words)
    options.out.mkdir()
    (options.out / "report.json").write_text(json.dumps(first.values([])))
    with pytest.raises(RunError, match="other rules or tracks"):
        second.earlier(options)


def test_a_mistake_names_the_program_s_own_package():
    with pytest.raises(RunError, match=r"see: rosrun marking mark.py --help"):
        MarkingTrial().parse(["--homework", "in"])


def test_without_submissions_the_line_says_how_make_calls_them():
    with pytest.raises(RunError, match=r"--submissions \(SUBMISSIONS=\) is missing"):
        MarkingTrial().parse([])
