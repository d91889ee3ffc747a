"""A little of `make fuzz`, with fixed seeds; and what its command refuses."""

import asyncio
import subprocess
import sys
from pathlib import Path

import pytest

from evaluation.command_line import run_program
from run_session.failure import RunError

pytestmark = pytest.mark.processes
FUZZ = Path(__file__).parent / "fuzz"
SEED = 1
EXAMPLES = {"http": 30, "nodes": 30, "simulator": 15}  # those that start more than a reader
USUAL = 100  # of each other target: about a minute of processor time in all


@pytest.fixture(scope="module")
def fuzz(modules):
    return modules("fuzz", "campaign", "page", "pictures", "sandbox", "targets")


@pytest.mark.parametrize("name", [
    "urdf", "sdf", "world", "xacro", "ogre", "stl", "obj", "collada", "map", "track",
    "texture", "map_image", "drawing", "onnx", "bag_info", "bag_map", "form", "page", "http",
    "simulator", "nodes"])
def test_spoilt_input_is_taken_or_refused_by_one_line(fuzz, tmp_path, name):
    examples = EXAMPLES.get(name, USUAL)
    report = fuzz["campaign"].Report(fuzz["targets"].TARGETS[name], tmp_path)
    try:
        fuzz["campaign"].run(report, SEED, examples)
    finally:
        report.close()
    assert report.inputs > examples // 2
    assert not report.findings, "\n".join(report.findings.values())


def test_good_requests_are_answered(fuzz):
    page = fuzz["page"]
    for request in page.REQUESTS:
        assert asyncio.run(page._exchange(request)).startswith(b"HTTP/1.1 "), request


def test_every_target_has_its_turn_here(fuzz):
    (marks,) = (mark for mark in test_spoilt_input_is_taken_or_refused_by_one_line.pytestmark
                if mark.name == "parametrize")
    assert set(marks.args[1]) == set(fuzz["targets"].TARGETS)


def test_every_form_and_map_is_read_before_it_is_spoilt(fuzz):
    page, pictures = fuzz["page"], fuzz["pictures"]
    for kind in page.KINDS:
        assert page.kind_of(page.template(kind)) is kind
    beside = {path.name for path in fuzz["targets"].TARGETS["map"].beside}
    for path in pictures.found("**/maps/*.yaml", "**/map/*.yaml"):
        assert pictures.read_map(path) and path.with_suffix(".pgm").name in beside


@pytest.mark.parametrize("read, fault", [
    ("lambda path: 1 / 0", "ZeroDivisionError"), ("lambda path: os.abort()", "crashes: SIGABRT"),
    ("lambda path: [0] * 2**30", "MemoryError"), ("lambda path: spin()", "hangs"),
    ("lambda path: refuse('a\\nb')", "more than a line"), ("lambda path: refuse('a')", None),
    ("lambda path: refuse(' ')", "without a word"), ("lambda path: None", None)])
def test_each_kind_of_fault_is_noticed(fuzz, monkeypatch, read, fault):
    import os
    from dataclasses import replace

    def refuse(text):
        raise KeyboardInterrupt(text)

    def spin():
        while True:
            pass

    monkeypatch.setattr(fuzz["sandbox"], "LIMIT", 0.4)  # s
    spoilt = replace(fuzz["targets"].TARGETS["ogre"], refusals=(KeyboardInterrupt,),
                     read=eval(read, {"os": os, "spin": spin, "refuse": refuse}))
    found = fuzz["campaign"].replay(spoilt, b"x")
    assert found is None if fault is None else fault in found


@pytest.fixture
def command(monkeypatch):
    monkeypatch.syspath_prepend(str(FUZZ))
    import fuzz
    return fuzz


@pytest.mark.parametrize("words, said", [
    (["--target", "none"], "no target 'none' (TARGET=); there are: urdf, "),
    (["--minutes", "soon"], "--minutes (MINUTES=) must be a number of minutes"),
    (["--minutes=-1"], "--minutes (MINUTES=) must be a number of minutes"),
    (["--input", "nowhere"], "INPUT= needs the TARGET="),
    (["--target", "stl", "--input", "nowhere"], "nowhere cannot be read")])
def test_a_mistake_is_one_line(command, capsys, words, said):
    try:
        code = run_program("fuzz", lambda: command.main(words))
    except SystemExit as end:  # of argparse
        code = end.code
    shown = capsys.readouterr().err
    assert code == 2 and said in shown and shown.count("\n") == 1


def test_the_program_ends_with_its_code():
    """Once as a process: it takes seconds to import all that it spoils the input of."""
    done = subprocess.run([sys.executable, FUZZ / "fuzz.py", "--input", "nowhere"], text=True,
                          capture_output=True, timeout=120)
    assert done.returncode == 2 and done.stderr.count("\n") == 1


def test_a_folder_that_can_hold_no_finding_is_one_line(command, tmp_path, monkeypatch):
    (tmp_path / "out").write_text("")
    monkeypatch.setattr(command, "OUT", tmp_path / "out")
    with pytest.raises(RunError, match=f"^nothing can be kept in {tmp_path / 'out'}: File exists$"):
        command.main(["--target", "ogre", "--minutes", "0.001"])
