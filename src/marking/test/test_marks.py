"""From a drive to points, and to pages that do not obey what strangers wrote."""

import csv

import pytest
from made_up import RULES
from marking.bubblewrap import Kind
from marking.case_files import FILM, OUTPUT, PATH_PICTURE, THUMBNAIL
from marking.marks import student_file, write_marks, write_student_pages
from marking.points import Mark, by_student, did, mean, points_of, sentence
from marking.rules import Points, load_rules
from marking.submissions import file_name, one_line

EVIL = "<script>alert(1)</script>"


@pytest.fixture(autouse=True)
def _in_english(monkeypatch):
    monkeypatch.setenv("LANGUAGE", "en")


def write(tmp_path, kind=Kind.USER):
    folder = tmp_path / "cases" / "张伟" / "track0-seed1"
    folder.mkdir(parents=True)
    (folder / OUTPUT).write_bytes(f"printed {EVIL} \xff".encode("latin-1"))
    rows = [
        Mark("b/0-1", "=cmd()", "track0-seed1", "fault", 0.0, (f"-100: {EVIL}",), "",
             did="the program failed"),
        Mark("a/0-1", "张伟", "track0-seed1", "closed", 90.5,
             ("-8: 9.0 cm off the line (3 cm or less costs nothing)", "-1.5: slow"),
             "cases/张伟/track0-seed1", did="lap finished"),
        Mark("a/0-2", "张伟", "track0-seed2", "closed", 80.5, (), "", did="lap finished")]
    for mark in rows[:2]:  # of the first there is no drive any more
        for made in (PATH_PICTURE, THUMBNAIL, FILM):
            path = student_file(tmp_path, mark.student, mark.case, made)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(b"made")
        path.with_suffix(".html").write_text("<!doctype html>")
    marks = by_student(rows)
    write_student_pages(marks, load_rules(RULES), tmp_path)
    write_marks(marks, load_rules(RULES), kind, tmp_path)


def read_table(tmp_path):
    with (tmp_path / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_the_table_has_a_mean_and_each_case(tmp_path):
    write(tmp_path)
    rows = read_table(tmp_path)
    assert [row["student"] for row in rows] == ["'=cmd()", "张伟"]  # no formula
    assert rows[1]["points"] == "85.5"
    assert [rows[1]["track0-seed1"], rows[1]["track0-seed2"]] == ["90.5", "80.5"]
    assert rows[1]["why points were lost"] == (
        "track 0, seed 1: 90.5 of 100: lap finished. -8: 9.0 cm off the line "
        "(3 cm or less costs nothing). -1.5: slow; track 0, seed 2: 80.5 of 100: lap finished")
    assert rows[1]["sandbox"] == "yes"


def test_in_chinese_the_table_has_a_second_row_of_headings(tmp_path, monkeypatch):
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    write(tmp_path)
    heads, *rows = read_table(tmp_path)  # the first row is for programs, as it was
    assert ";".join(heads.values()) == (
        "学生;得分;满分;赛道 0，种子 1;赛道 0，种子 2;沙箱;为什么扣分;备注")
    assert rows[0]["why points were lost"] == f"0 分（满分 100）：程序出错。-100：{EVIL}"
    assert "-8：偏离线 9.0 厘米（3 厘米以内不扣分）" in rows[1]["why points were lost"]


def test_pages_are_in_the_wanted_language(tmp_path, monkeypatch):
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    write(tmp_path)
    page = (tmp_path / "students" / "张伟" / "index.html").read_text(encoding="utf-8")
    for said in ('lang="zh-CN"', "85.5 分（满分 100）", "赛道 0，种子 1", "跑完一圈",
                 "-8：偏离线 9.0 厘米（3 厘米以内不扣分）", "三维回放", "程序的输出："):
        assert said in page
    table = (tmp_path / "marks.html").read_text(encoding="utf-8")
    for said in ("<h1>成绩</h1>", "小车跑得怎么样",
                 "课程：course，2 份作业，平均 42.8 分（满分 100）。"):
        assert said in table


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
    for loss in ("-8: 9.0 cm off the line (3 cm or less costs nothing)", "-1.5: slow"):
        assert f"<li>{loss}</li>" in page
    table = (tmp_path / "marks.html").read_text()
    for ending in ('href="{}.png"', 'src="{}.webp"', 'href="{}.mp4"', 'href="{}.html"'):
        assert ending.format("students/%E5%BC%A0%E4%BC%9F/track0-seed1") in table
    for ending in ("png", "html"):
        assert (tmp_path / "students" / "张伟" / f"track0-seed1.{ending}").exists()
    assert [each.name for each in (tmp_path / "students" / "=cmd()").iterdir()] == ["index.html"]
    for each in tmp_path.rglob("*.html"):
        assert EVIL not in each.read_text()


def test_terminal_codes_are_shown_as_text(tmp_path):
    write(tmp_path)
    output = tmp_path / "cases" / "张伟" / "track0-seed1" / OUTPUT
    output.write_text("\x1b]0;own\x07\x1b[31m红\x1b[0m\n\tb\u202e\x00\x9b2J", encoding="utf-8")
    marks = [Mark("a/0-1", "张伟", "track0-seed1", "closed", 90.5, (), "cases/张伟/track0-seed1",
                  did="lap finished")]
    write_student_pages(by_student(marks), load_rules(RULES), tmp_path)
    page = (tmp_path / "students" / "张伟" / "index.html").read_text(encoding="utf-8")
    assert r"<pre>\x1b]0;own\x07\x1b[31m红\x1b[0m" "\n\tb" r"\u202e\x00\x9b2J</pre>" in page


def test_what_strangers_wrote_becomes_one_line():
    assert one_line("a\x1b[2J\nb\r") == "a [2J b"
    assert one_line("\udcff") == "?"
    assert file_name(b"\xd0\xa1\xb3\xb5.py".decode("utf-8", "surrogateescape")) == "小车.py"


POINTS = Points(60, 25, 0.03, 0.15, 15, 0.2, 0.05)
DRIVE = {"outcome": "closed", "violations": [], "fault": "", "exception": "", "why": "",
         "laps_wanted": 1, "laps_closed": 1, "driven_share": 1.0, "rms_lateral_m": 0.03,
         "mean_speed_m_s": 0.2}
LEFT = {**DRIVE, "outcome": "left the course", "laps_closed": 0, "driven_share": 0.25,
        "why": "the car left the course at x=1.41, y=-0.84, simulated time 19.4 s: 0.25 m to the "
               "right of the line"}
RAISED = "exception in a.py, line 3: ZeroDivisionError: division by zero"


def said(drive):
    """The sentence about a drive."""
    points, lost = points_of(drive, POINTS)
    return sentence(Mark("a/0-1", "a", "track0-seed1", drive["outcome"], points, tuple(lost), "",
                         did=did(drive)), POINTS.most)


def test_a_perfect_drive_loses_nothing():
    assert points_of(DRIVE, POINTS) == (100, [])
    assert said(DRIVE) == "100 of 100: lap finished"
    assert said({**DRIVE, "laps_wanted": 3, "laps_closed": 3}) == "100 of 100: 3 laps finished"


def test_beside_the_line_and_slow():
    drive = {**DRIVE, "rms_lateral_m": 0.0545, "mean_speed_m_s": 0.125}
    assert points_of(drive, POINTS)[0] == pytest.approx(100 - 5.1 - 7.5, abs=0.01)
    assert said(drive) == (
        "87.4 of 100: lap finished. -5.1: 5.5 cm off the line (3 cm or less costs nothing). "
        "-7.5: 0.125 m/s on average (0.2 m/s or more costs nothing)")


def test_the_same_in_chinese(monkeypatch):
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    assert said({**LEFT, "exception": RAISED, "rms_lateral_m": 0.09}) == (
        "21.9 分（满分 100）：跑了全程的 25%。-75：a.py 第 3 行出现异常：ZeroDivisionError: "
        "division by zero；小车离开了跑道，在 x=1.41，y=-0.84，仿真时间 19.4 秒：位于线的右侧 "
        "0.25 米处。-3.1：偏离线 9.0 厘米（3 厘米以内不扣分）")


def test_a_part_of_the_way_counts_as_that_part():
    assert points_of(LEFT, POINTS)[0] == 25
    assert said(LEFT) == f"25 of 100: 25% of the way driven. -75: {LEFT['why']}"


def test_the_first_cause_comes_first():
    assert points_of({**LEFT, "exception": RAISED}, POINTS)[1] == [
        f"-75: {RAISED}; {LEFT['why']}"]
    ended = {**LEFT, "exception": RAISED, "fault": "the program ended (exit code 1)"}
    assert said(ended) == (f"0 of 100: the program failed. -100: {RAISED}; the program ended "
                           "(exit code 1); 25% of the way driven")


def test_a_car_that_never_moved_loses_all_for_that_alone():
    stood = {**LEFT, "driven_share": 0.0, "rms_lateral_m": 0.0, "mean_speed_m_s": 0.0,
             "why": "the car stalled: it never moved in 30 s"}
    assert said(stood) == ("0 of 100: the car never moved. "
                           "-100: the car stalled: it never moved in 30 s")


def test_what_is_not_allowed_takes_all():
    drive = {**DRIVE, "violations": ["it called /x", "it published /y"], "outcome": "not allowed"}
    assert points_of(drive, POINTS)[0] == 0
    assert said(drive) == "0 of 100: not allowed. -100: it called /x; it published /y"


def test_the_mean_of_the_cases():
    assert mean([100, 50.5]) == 75.25
