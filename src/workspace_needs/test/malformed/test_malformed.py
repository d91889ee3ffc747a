"""Spoilt robots, worlds and launch files: no crash, no hang, and a word on what is wrong.

More of them: `python3 src/workspace_needs/test/malformed/drive.py 0 500`, and `… drive.py parts`.
"""

import importlib.util
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
HERE = Path(__file__).resolve().parent
AT_ONCE = 10
FIRST, LAST = 0, 120
FOUND = ["heightmap line.png", "image line.png", "heightmap whole.png", "model file fifo.sdf",
         "launch include circle.launch", "load_yaml deep.yaml", "xacro include fifo.xacro",
         "rosparam fifo.yaml", "textfile fifo.yaml"]


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """The module drive.py, which finds mutations.py beside it."""
    sys.path.insert(0, str(HERE))
    try:
        spec = importlib.util.spec_from_file_location("malformed_drive", HERE / "drive.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules["malformed_drive"] = module  # where its dataclass looks for its own module
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(HERE))
    return module


@pytest.mark.parametrize("first", range(FIRST, LAST, AT_ONCE))
def test_a_malformed_file_gives_one_error_line_within_5_s(drive, tmp_path, first):
    outcomes = [drive.run(seed, tmp_path) for seed in range(first, first + AT_ONCE)]
    bad = [f"{outcome.line()}\n{outcome.output[-500:]}" for outcome in outcomes if outcome.fault()]
    assert not bad, "\n".join(bad)


@pytest.mark.parametrize("name", FOUND)
def test_spoilt_parts_and_large_texts_that_were_once_trouble(drive, tmp_path, name):
    outcome = drive.run_case(name, tmp_path)
    assert outcome.fault() is None, f"{outcome.line()}\n{outcome.output[-500:]}"


def test_every_other_one_has_a_file(drive, tmp_path):
    for name, write in drive.PARTS.items():
        folder = tmp_path / name
        folder.mkdir()
        assert write(folder).is_file()
    assert set(FOUND) <= {*drive.PARTS, *drive.LARGE} and not set(drive.PARTS) & set(drive.LARGE)


def test_the_same_seed_gives_the_same_file(drive):
    text = drive.sources()[0].read_text(encoding="utf-8")
    assert [drive.mutant(text, seed) for seed in range(40)] == [
        drive.mutant(text, seed) for seed in range(40)]


@pytest.mark.parametrize("code, seconds, memory, output, fault", [
    (0, 1.0, 1, "works", None),
    (1, 1.0, 1, "PROBLEM robot: x", None),
    (1, 1.0, 1, "something else", "no word"),
    (1, 1.0, 1, "PROBLEM\nTraceback (most recent call last)", "traceback"),
    (-11, 1.0, 1, "", "ended with -11"),
    (0, 6.0, 1, "", "took"),
    (0, 1.0, 2 << 30, "", "MB"),
    (1, 1.0, 1, "PROBLEM " + "x" * 2000, "a line of"),
])
def test_what_counts_as_a_fault(drive, code, seconds, memory, output, fault):
    found = drive.Outcome("truncated", code, seconds, memory, output).fault()
    assert found is None if fault is None else fault in found
