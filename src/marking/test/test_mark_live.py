"""`make mark` with the real simulator: a small class, Ctrl-C, and going on."""

import csv
import signal
import subprocess
import sys
import time
from pathlib import Path

import made_up
import psutil
import pytest

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parents[1] / "scripts" / "mark.py"
LIMIT = 500.0  # s, wall: a lap, and three starts of the course on a busy machine
CLASS = {"good", "sets_state", "odom", "made_up_publisher", "straight_call", "zip_bomb.zip",
         "report.docx"}


def command(folder: Path, *options: str) -> list[str]:
    return [sys.executable, str(SCRIPT), "--submissions", str(folder / "in"), "--rules",
            str(folder / "marking.yaml"), "--out", str(folder / "out"), *options]


def mark(folder: Path, *options: str) -> subprocess.CompletedProcess:
    done = subprocess.run(command(folder, *options), capture_output=True, text=True,
                          timeout=LIMIT)
    if "no sandbox:" in done.stderr:
        pytest.skip(done.stderr)
    return done


def rows_of(folder: Path) -> dict[str, dict[str, str]]:
    with (folder / "out" / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        return {row["student"]: row for row in csv.DictReader(file)}


@pytest.mark.timeout(2 * LIMIT)
def test_a_class_is_marked_and_goes_on_where_it_was_interrupted(tmp_path):
    expected = made_up.write(tmp_path / "in", CLASS)
    made_up.write_rules(tmp_path / "marking.yaml", start_s=120)
    done = mark(tmp_path, "--workers", "2")
    assert done.returncode == 0, done.stdout + done.stderr
    assert made_up.wrong_rows(list(rows_of(tmp_path).values()), expected) == []
    assert (tmp_path / "out/students/good/track0-seed1.png").stat().st_size > 10_000
    assert " of 100: lap finished" in (tmp_path / "out/students/good/track0-seed1.html").read_text()
    assert [each for each in psutil.Process().children(recursive=True)
            if each.status() != psutil.STATUS_ZOMBIE] == []
    marks = (tmp_path / "out" / "marks.csv").read_bytes()
    (tmp_path / "out" / "marks.csv").unlink()
    again = mark(tmp_path, "--resume")
    assert again.returncode == 0
    assert "[1/" not in again.stdout  # nothing drove
    assert (tmp_path / "out" / "marks.csv").read_bytes() == marks
    (tmp_path / "in" / "zip_bomb.zip").write_bytes(b"PK no zip")
    again = mark(tmp_path, "--resume")
    assert "zip_bomb: the submission has changed, it is marked again" in again.stdout
    assert "cannot be unpacked" in rows_of(tmp_path)["zip_bomb"]["why points were lost"]
    assert len(again.stdout.split("[7/7]")) == 2  # it alone


@pytest.mark.timeout(LIMIT)
def test_ctrl_c_keeps_what_is_done(tmp_path):
    made_up.write(tmp_path / "in", {"broken.zip", "endless_import"})
    made_up.write_rules(tmp_path / "marking.yaml", start_s=LIMIT)
    running = subprocess.Popen(command(tmp_path), stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + LIMIT / 2
    while not list(tmp_path.glob("out/cases/endless_import/*/output.txt")):
        if running.poll() is not None:
            pytest.skip(running.stderr.read())
        assert time.monotonic() < until
        time.sleep(0.2)
    running.send_signal(signal.SIGINT)
    assert running.wait(120.0) == 130
    assert set(rows_of(tmp_path)) == {"broken"}
    assert [each for each in psutil.Process().children(recursive=True)
            if each.status() != psutil.STATUS_ZOMBIE] == []


def test_a_course_that_is_not_there_is_one_line(tmp_path):
    made_up.write(tmp_path / "in", {"good"})
    made_up.write_rules(tmp_path / "marking.yaml")
    done = mark(tmp_path, "--course", "moon")
    assert done.returncode == 2
    assert done.stderr == ("mark: --course (COURSE=) must be one of course, race, lane, "
                           "is 'moon'\n")


def test_rules_that_submissions_could_read_are_refused(tmp_path):
    made_up.write(tmp_path / "in", {"good"})
    shown = made_up.RULES.parents[1] / "test" / f"{tmp_path.name}.yaml"
    try:
        done = mark(tmp_path, "--rules", str(made_up.write_rules(shown)))
    finally:
        shown.unlink()
    assert done.returncode == 2
    assert "every submission could read it there" in done.stderr


SMALL_DISK = """
import os, subprocess, sys
folder, size = sys.argv[1:3]
subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder], check=True)
done = subprocess.run(sys.argv[3:], capture_output=True, text=True)
print(done.returncode, done.stdout, done.stderr)
"""


@pytest.mark.timeout(LIMIT)
@pytest.mark.skipif(subprocess.run(["unshare", "-rm", "true"]).returncode, reason="no namespaces")
@pytest.mark.parametrize("size", ["64k", "1500k"])
def test_a_full_disk_is_no_fault_of_a_submission(tmp_path, size):
    (tmp_path / "in" / "large").mkdir(parents=True)
    (tmp_path / "in" / "large" / "follower.py").write_bytes(b"#" * 2_000_000)
    made_up.write_rules(tmp_path / "marking.yaml")
    (tmp_path / "out").mkdir()
    done = subprocess.run(
        ["unshare", "-rm", sys.executable, "-c", SMALL_DISK, tmp_path / "out", size,
         *command(tmp_path), "--no-sandbox"], capture_output=True, text=True, timeout=LIMIT)
    assert done.stdout.startswith("2 ")
    assert f"mark: no space left on {tmp_path / 'out'} for {tmp_path / 'out'}" in done.stdout
    assert "give a folder elsewhere: make mark OUT=DIR" in done.stdout
    assert "points," not in done.stdout
