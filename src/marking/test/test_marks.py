"""From a drive to points, and to pages that do not obey what strangers wrote."""

import csv

from made_up import RULES
from marking.bubblewrap import Kind
from marking.case_files import OUTPUT, PATH_PICTURE
from marking.marks import (
    Mark,
    by_student,
    mean,
    points_of,
    student_file,
    write_marks,
    write_student_pages,
)
from marking.rules import Points, load_rules
from marking.submissions import file_name, one_line

EVIL = "<script>alert(1)</script>"


def write(tmp_path, kind=Kind.USER):
    folder = tmp_path / "cases" / "张伟" / "track0-seed1"
    folder.mkdir(parents=True)
    (folder / OUTPUT).write_bytes(f"printed {EVIL} \xff".encode("latin-1"))
    rows = [
        Mark("b/0-1", "=cmd()", "track0-seed1", "fault", 0.0, (f"100 points: {EVIL}",), ""),
        Mark("a/0-1", "张伟", "track0-seed1", "closed", 90.5, ("9.5 points: slow",),
             "cases/张伟/track0-seed1"),
        Mark("a/0-2", "张伟", "track0-seed2", "closed", 80.5, (), "")]
    for mark in rows[:2]:  # of the first there is no drive any more
        path = student_file(tmp_path, mark.student, mark.case, PATH_PICTURE)
        path.parent.mkdir(parents=True)
        path.write_bytes(b"png")
        path.with_suffix(".html").write_text("<!doctype html>")
    marks = by_student(rows)
    write_student_pages(marks, load_rules(RULES), tmp_path)
    write_marks(marks, load_rules(RULES), kind, tmp_path)


def test_the_table_has_a_mean_and_each_case(tmp_path):
    write(tmp_path)
    with (tmp_path / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["student"] for row in rows] == ["'=cmd()", "张伟"]  # no formula
    assert rows[1]["points"] == "85.5"
    assert [rows[1]["track0-seed1"], rows[1]["track0-seed2"]] == ["90.5", "80.5"]
    assert rows[1]["why points were lost"] == "track0-seed1: 9.5 points: slow"
    assert rows[1]["sandbox"] == "yes"


def test_without_a_sandbox_the_marks_say_so(tmp_path):
    write(tmp_path, Kind.NONE)
    assert "without a sandbox" in (tmp_path / "marks.html").read_text()
    assert ",no," in (tmp_path / "marks.csv").read_text()


def test_pages_show_what_was_printed_and_run_none_of_it(tmp_path):
    write(tmp_path)
    page = (tmp_path / "students" / "张伟" / "index.html").read_text()
    assert "printed &lt;script&gt;" in page
    assert 'src="track0-seed1.png"' in page
    assert 'href="track0-seed1.html"' in page
    assert 'href="students/%E5%BC%A0%E4%BC%9F/track0-seed1.png"' in (
        tmp_path / "marks.html").read_text()
    for ending in ("png", "html"):
        assert (tmp_path / "students" / "张伟" / f"track0-seed1.{ending}").exists()
    assert [each.name for each in (tmp_path / "students" / "=cmd()").iterdir()] == ["index.html"]
    for each in tmp_path.rglob("*.html"):
        assert EVIL not in each.read_text()


def test_terminal_codes_are_shown_as_text(tmp_path):
    write(tmp_path)
    output = tmp_path / "cases" / "张伟" / "track0-seed1" / OUTPUT
    output.write_text("\x1b]0;own\x07\x1b[31m红\x1b[0m\n\tb\u202e\x00\x9b2J", encoding="utf-8")
    marks = [Mark("a/0-1", "张伟", "track0-seed1", "closed", 90.5, (), "cases/张伟/track0-seed1")]
    write_student_pages(by_student(marks), load_rules(RULES), tmp_path)
    page = (tmp_path / "students" / "张伟" / "index.html").read_text(encoding="utf-8")
    assert r"<pre>\x1b]0;own\x07\x1b[31m红\x1b[0m" "\n\tb" r"\u202e\x00\x9b2J</pre>" in page


def test_what_strangers_wrote_becomes_one_line():
    assert one_line("a\x1b[2J\nb\r") == "a [2J b"
    assert one_line("\udcff") == "?"
    assert file_name(b"\xd0\xa1\xb3\xb5.py".decode("utf-8", "surrogateescape")) == "小车.py"


POINTS = Points(60, 25, 0.03, 0.15, 15, 0.2, 0.05)
DRIVE = {"violations": [], "fault": "", "why": "", "laps_wanted": 1, "laps_closed": 1,
         "driven_share": 1.0, "rms_lateral_m": 0.03, "mean_speed_m_s": 0.2}


def test_a_perfect_drive_loses_nothing():
    assert points_of(DRIVE, POINTS) == (100, [])


def test_beside_the_line_and_slow():
    points, lost = points_of({**DRIVE, "rms_lateral_m": 0.09, "mean_speed_m_s": 0.125}, POINTS)
    assert points == 60 + 12.5 + 7.5
    assert [each.split(":")[0] for each in lost] == ["12.5 points", "7.5 points"]


def test_a_part_of_the_way_counts_as_that_part():
    points, lost = points_of({**DRIVE, "laps_closed": 0, "driven_share": 0.25,
                              "why": "the car left the course"}, POINTS)
    assert points == 25
    assert lost[0] == "45.0 points: the car left the course"


def test_what_is_not_allowed_takes_all():
    points, lost = points_of({**DRIVE, "violations": ["it called /x", "it published /y"]}, POINTS)
    assert points == 0
    assert lost == ["100 points: it called /x, it published /y"]


def test_the_mean_of_the_cases():
    assert mean([100, 50.5]) == 75.25
