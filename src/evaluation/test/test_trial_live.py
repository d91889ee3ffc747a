"""A single drive, with nothing that drives: what is kept when it is interrupted."""

import errno
import os
import signal
import subprocess
import sys
import threading
from argparse import Namespace
from types import SimpleNamespace
from typing import ClassVar

import pytest

from evaluation import command_line, live
from evaluation.command_line import results_folder, run_program


class FakeDrive(live.LiveDrive):
    """Ends at once; `reports` has what it wrote."""

    program, writes = "drive", ("report.json",)

    def __init__(self, out):
        super().__init__(Namespace(out=out, video=False, any_port=False))
        self.reports = []

    def add_options(self, parser): ...
    def bring_up(self, launched): ...
    def end(self): ...

    def watch(self, launched):
        return live.Outcome("passed")

    def figures(self, outcome, log):
        return {"outcome": outcome.word}

    def write(self, report):
        self.reports.append(report)
        return []


class Ending:
    """A session while whose processes end Ctrl-C is typed; `joined`: what each was asked for."""

    joined: ClassVar[list[bool]] = []

    def __init__(self, out):
        self.out, self.family = out, SimpleNamespace(spared=None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        raise KeyboardInterrupt

    def launched(self, *_, joined):
        self.joined.append(joined)
        return SimpleNamespace(start_roscore=lambda: None, master_uri="", why_not_callers="")


def test_ctrl_c_after_the_drive_does_not_lose_its_report(tmp_path, monkeypatch):
    monkeypatch.setattr(live, "Session", Ending)
    drive = FakeDrive(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        live.run_live(drive)
    assert [report["outcome"] for report in drive.reports] == ["passed"]


def test_a_long_end_of_an_interrupted_drive_is_said_once(tmp_path, monkeypatch):
    said, told = [], threading.Event()
    drive = FakeDrive(tmp_path)

    class Slow(Ending):
        def __exit__(self, *_):
            assert told.wait(60)

    def say(line):
        said.append(line)
        told.set()

    monkeypatch.setattr(live, "Session", Slow)
    monkeypatch.setattr(live, "PATIENCE", 0.0)
    monkeypatch.setattr(drive, "watch", lambda _: os.kill(os.getpid(), signal.SIGINT))
    monkeypatch.setattr(drive.progress, "say", lambda line: said or "ending" not in line
                        or say(line))
    assert run_program("drive", lambda: live.run_live(drive)) == 130
    assert said == ["the drive is ending, and its files are being written"]


CUT_OFF = """
from test_trial_live import *

class Interrupting(Ending):
    def __exit__(self, *_):
        sys.stdin.read()
        raise KeyboardInterrupt

live.Session, Film.codec = Interrupting, "h264"
FakeDrive.write = lambda drive, report: [(drive.out / "report.json").write_text(str(report))] * 0
drive = FakeDrive(live.Path(sys.argv[1]))
drive.film = Film()
print("ready", flush=True)
sys.exit(run_program("drive", lambda: live.run_live(drive)))
"""


@pytest.mark.processes
def test_ctrl_c_that_ends_tee_too_does_not_lose_the_film(tmp_path):
    run = subprocess.Popen([sys.executable, "-c", CUT_OFF, str(tmp_path)], text=True,
                           cwd=os.path.dirname(__file__), stdin=subprocess.PIPE,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert run.stdout.readline() == "ready\n"
    run.stdout.close()
    run.stdin.close()
    assert run.wait(60) == 130
    assert "h264" in (tmp_path / "report.json").read_text()


class Whole(Ending):
    """A session that ends by itself."""

    def __exit__(self, *_): ...


def test_other_terminals_join_a_drive_but_none_of_a_trial_s(tmp_path, monkeypatch):
    monkeypatch.setattr(live, "Session", Whole)
    Whole.joined.clear()
    for any_port in (False, True):
        drive = FakeDrive(tmp_path)
        drive.options.any_port = any_port
        assert live.run_live(drive) == 0
    assert Whole.joined == [True, False]


class Film:
    """Nothing else may leave it half written: the encoder would go on when we have ended."""

    process_id, codec, closed = None, "", 0

    def stop(self): ...

    def close(self):
        self.closed += 1
        return ""


def test_a_full_disk_is_one_line_and_the_film_is_closed_too(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(live, "Session", Whole)
    drive = FakeDrive(tmp_path)
    drive.film = Film()

    def write(report):
        raise OSError(errno.ENOSPC, "No space left on device", str(tmp_path / "report.json"))

    monkeypatch.setattr(drive, "write", write)
    assert run_program("drive", lambda: live.run_live(drive)) == 2
    assert drive.film.closed == 1
    said = capsys.readouterr().err
    disk = next(each for each in (tmp_path, *tmp_path.parents) if each.is_mount())
    assert said == (f"drive: no space left on {disk} for {tmp_path / 'report.json'}: make room, "
                    "or give a folder elsewhere: scripts/drive.sh --out DIR\n")


def test_a_folder_that_another_run_writes_is_refused_until_its_process_has_died(
        tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(live, "Session", Whole)
    drive, made = FakeDrive(tmp_path / "out"), tmp_path / "out" / "report.json"
    with results_folder("drive", drive.out):
        made.touch()
        assert run_program("drive", lambda: live.run_live(drive)) == 2
    assert made.exists() and drive.reports == []
    assert capsys.readouterr().err == (
        f"drive: {drive.out} is being written by another run (PID {os.getpid()}): end it, or give "
        "a folder elsewhere: scripts/drive.sh --out DIR\n")
    holds = subprocess.Popen(
        [sys.executable, "-c", "import sys, pathlib\nfrom evaluation.command_line import *\n"
         "with results_folder('a', pathlib.Path(sys.argv[1])): print(flush=True); input()",
         str(drive.out)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    holds.stdout.readline()
    assert run_program("drive", lambda: live.run_live(drive)) == 2
    assert f"(PID {holds.pid})" in capsys.readouterr().err
    monkeypatch.setattr(command_line, "LOCKS", tmp_path / "not there")
    assert run_program("drive", lambda: live.run_live(drive)) == 2
    assert "(PID ?)" in capsys.readouterr().err
    holds.kill()
    holds.communicate()
    assert run_program("drive", lambda: live.run_live(drive)) == 0
