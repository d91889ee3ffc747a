"""make replay's refusals: one line each, before anything is started."""

import gzip
import os

import pytest

from bullet_sim.formats.run_log import RunLog, header, part
from evaluation.command_line import results_folder
from evaluation.replay import OF, Replay, main
from evaluation.run_log import RUN_LOG, add_marks


def head(**values):
    return header(timestep=0.001, tick=0, run={}, **values)


LINES = [["i", 34, "01"], ["to", "/cmd_vel", 0], [0, "00"], ["i", 33, "02"]]


@pytest.fixture
def said(monkeypatch, capsys):
    """`said(words...)`: exit code and standard error."""
    def run(*words):
        monkeypatch.setattr("sys.argv", ["replay.py", *map(str, words)])
        code = main()
        return code, capsys.readouterr().err
    return run


@pytest.fixture
def out(tmp_path):
    folder = tmp_path / "course"
    folder.mkdir()
    return folder


def test_no_run(said, tmp_path):
    assert said("--run", tmp_path / "x") == (2, (
        f"replay: no run at {tmp_path}/x (RUN=): give the folder of its results, as out/course\n"))


@pytest.mark.parametrize(("films", "hint"), [
    ((), ""), (("run.mp4",), "; look at its film: {}/run.mp4"),
    (("run.mp4", "run.html"), "; look at its film: {}/run.html")])
def test_a_run_in_real_time_has_a_film(said, out, films, hint):
    for name in films:
        (out / name).touch()
    assert said("--run", out) == (2, (
        f"replay: {out} has no run.log.gz: only a run in lockstep, as by FAST=1, can be repeated, "
        f"not one in real time{hint.format(out)}\n"))


@pytest.mark.parametrize(("lines", "at", "line"), [
    ([*LINES, ["end"]], "image:3", "the log has no image:3; there are image:1 to image:2"),
    ([*LINES, ["end"]], "7", "the log has no image at 7 s; its last one is at 0.067 s"),
    (LINES, "image:0", "the log has no image:0; there are image:1 to image:2"),
    (LINES, "0.x", "the log has no mark '0.x' nor any other: name a time in s, image:N or end"),
    ([*LINES, ["mark", "lap", 0.03, "1"]], "lost",
     "the log has no mark 'lost'; there are: lap; or name a time in s, image:N or end"),
    ([], "end", "the log has no image: the run ended before the first one"),
    ([["i", 1, "01"], ["lacks", "/switch"], *LINES], "image:2",
     "at 0.001 s the run used /switch, which is not in its log")])
def test_an_image_that_cannot_be_gone_to(said, out, lines, at, line):
    (out / RUN_LOG).write_bytes(part([head(), *lines]))
    for run in (out, out / RUN_LOG):
        assert said("--run", run, "--at", at) == (2, f"replay: {out / RUN_LOG}: {line}\n")


def test_a_second_one_says_what_to_type(said, out, tmp_path):
    run = head() | {"run": dict.fromkeys(OF, "")}
    (out / RUN_LOG).write_bytes(part([run, *LINES, ["end"]]))
    with results_folder("replay", tmp_path / "replay"):
        code, line = said("--run", out, "--out", tmp_path / "replay")
    assert (code, line) == (2, (
        f"replay: {tmp_path}/replay is being written by another run (PID {os.getpid()}): end it, "
        "or give a folder elsewhere: make replay OUT=DIR (scripts/replay.sh --out DIR)\n"))


def test_another_version_s_log(said, out):
    (out / RUN_LOG).write_bytes(part([head() | {"version": "0.1"}]))
    code, line = said("--run", out)
    assert code == 2 and line.count("\n") == 1
    assert "was written by version 0.1, this is" in line


def test_a_log_that_was_not_written_by_make(said, out):
    (out / RUN_LOG).write_bytes(part([head(), *LINES, ["end"]]))
    assert said("--run", out) == (2, (
        f"replay: {out}/run.log.gz does not say how its run was started (words): only runs of make "
        "course, race, track, lane and avoid can be gone back to\n"))


def test_what_is_no_log(said, out):
    (out / "hall-3.run.log.gz").write_bytes(gzip.compress(b"nothing"))
    assert said("--run", out / "hall-3") == (2, (
        f"replay: {out}/hall-3.run.log.gz is not the log of a run, or was cut short at once\n"))


def test_without_a_standard_input_it_goes_on(monkeypatch):
    monkeypatch.setattr("sys.stdin", None)  # <&-
    Replay(None, None, RunLog(head()))._read()


def test_marks_are_added_to_a_log_that_is_there(tmp_path):
    add_marks(tmp_path / RUN_LOG, [])
    assert not (tmp_path / RUN_LOG).exists()
