"""The log of a run is read as it was written, also up to where it was cut; else one line."""

import gzip
import json

import pytest

from bullet_sim.formats.run_log import (
    Event,
    Mark,
    RunLogError,
    append_marks,
    header,
    part,
    read_run_log,
)

LINES = [["setup", "/spawn", "ab"], ["i", 34, "01"], ["to", "/cmd_vel", 1], [0, "0aff"],
         ["i", 33, "02"], ["t", 3], [0, "0b"]]
REST = [["i", 30, "03"], ["mark", "contact", 0.07, "car wall"], ["lacks", "/switch"], ["end"]]


@pytest.fixture
def path(tmp_path):
    found = tmp_path / "run.log.gz"
    found.write_bytes(part([header(timestep=0.001, tick=0), *LINES]) + part(REST))
    return found


def test_it_is_read_as_it_was_written(path):
    log = read_run_log(path)
    assert log.setup == [("/spawn", "ab")] and log.whole
    assert log.events == [
        Event(34, "image", number=1, data=b"\1"), Event(34, "input", "/cmd_vel", 1, b"\x0a\xff"),
        Event(67, "image", number=2, data=b"\2"), Event(70, "input", "/cmd_vel", 1, b"\x0b"),
        Event(100, "image", number=3, data=b"\3"), Event(100, "lacks", "/switch")]
    assert [log.time_of(image) for image in log.images] == [0.034, 0.067, 0.1]


def test_marks_can_be_added_and_are_in_order(path):
    append_marks(path, [Mark("lap", 0.1, "1"), Mark("lap", 0.034), Mark("big corner", 0.099)])
    log = read_run_log(path)
    assert [mark.time for mark in log.marks] == [0.034, 0.07, 0.099, 0.1]
    assert log.marks[1] == Mark("contact", 0.07, "car wall")


@pytest.mark.parametrize(("at", "number"), [
    ("image:3", 3), ("end", 3), ("0", 1), ("0.034", 1), ("0.066", 1), ("0.067", 2), ("0.1", 3),
    ("contact", 2), ("contact:1", 2), ("lap", 1), ("lap:2", 3), ("big corner", 2), ("a:b", 3)])
def test_an_image_is_found_by_number_time_or_mark(path, at, number):
    append_marks(path, [Mark("lap", 0.034), Mark("lap", 0.1), Mark("big corner", 0.07),
                        Mark("a:b", 0.1)])
    assert read_run_log(path).find(at) == number


@pytest.mark.parametrize(("at", "line"), [
    ("image:4", "the log has no image:4; there are image:1 to image:3"),
    ("image:0", "the log has no image:0; there are image:1 to image:3"),
    ("image:x", "the log has no image:x; there are image:1 to image:3"),
    ("0.2", "the log has no image at 0.2 s; its last one is at 0.100 s"),
    ("-1", "the log has no image at -1 s; its last one is at 0.100 s"),
    ("nan", "the log has no image at nan s; its last one is at 0.100 s"),
    ("lost", "the log has no mark 'lost'; there are: contact; or name a time in s, image:N or end"),
    ("contact:2", "the log has no mark 'contact:2'; there are: contact; or name a time in s, "
                  "image:N or end")])
def test_what_is_not_in_the_log_is_said(path, at, line):
    with pytest.raises(RunLogError) as said:
        read_run_log(path).find(at)
    assert str(said.value) == line


def test_a_log_that_was_cut_is_read_up_to_its_last_whole_part(path):
    whole = path.read_bytes()
    for cut in range(1, 9):
        path.write_bytes(whole[:-cut])
        log = read_run_log(path)
        assert len(log.images) == 2 and not log.whole
    path.write_bytes(whole + b"\0\0\0")  # as a file system may leave it after a power cut
    assert read_run_log(path).whole


def test_marks_behind_a_part_that_was_cut_short_are_read(path):
    whole = path.read_bytes()
    for cut in (1, 9, 30):
        path.write_bytes(whole[:-cut])
        append_marks(path, [Mark("lap", 0.034)])
        with path.open("ab") as file:
            file.write(part([["i", 30, "05"], ["end"]]))  # of an image that follows one unknown
        append_marks(path, [Mark("lost", 0.067)])
        log = read_run_log(path)
        assert [mark.name for mark in log.marks] == ["lap", "lost"]
        assert len(log.images) == 2 and not log.whole


@pytest.mark.parametrize("content", [b"", b"text", part([[]]), part([5])])
def test_what_is_no_log_is_refused(path, content):
    path.write_bytes(content)
    with pytest.raises(RunLogError, match=r"is not the log of a run, or was cut short at once$"):
        read_run_log(path)


@pytest.mark.parametrize("changed", [{"version": "0.9"}, {"run_log": 2}])
def test_a_log_of_another_version_is_refused(path, changed):
    path.write_bytes(gzip.compress(json.dumps(header() | changed).encode()))
    with pytest.raises(RunLogError, match=r"was written by version .* only the same version"):
        read_run_log(path)


@pytest.mark.parametrize("line", [
    [0, "00"], ["i", 1, "xy"], ["i"], ["new", 1], 5, ["mark"], ["to", "/a"]])
def test_a_damaged_line_is_refused(path, line):
    path.write_bytes(part([header(timestep=0.001, tick=0), line]))
    with pytest.raises(RunLogError, match=f"^{path} is damaged: "):
        read_run_log(path)
