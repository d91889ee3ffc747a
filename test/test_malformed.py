"""Spoilt robots, worlds and launch files: no crash, no hang, and a word on what is wrong.

More of them: `python3 test/malformed/malformed.py 0 500`, and `… malformed.py parts`.
"""

import pytest

pytestmark = pytest.mark.processes
AT_ONCE = 10
FIRST, LAST = 0, 60  # every mutation three times
FOUND = ["heightmap line.png", "image line.png", "heightmap whole.png", "model file fifo.sdf",
         "launch include circle.launch", "load_yaml deep.yaml", "xacro include fifo.xacro",
         "rosparam fifo.yaml", "textfile fifo.yaml"]


@pytest.fixture(scope="module")
def malformed(modules):
    """The program malformed.py, with the files beside it."""
    return modules("malformed", "malformed")["malformed"]


@pytest.mark.parametrize("first", range(FIRST, LAST, AT_ONCE))
def test_whatever_is_read_ends_soon_and_with_one_word(malformed, tmp_path, first):
    outcomes = [malformed.run(seed, tmp_path) for seed in range(first, first + AT_ONCE)]
    bad = [f"{outcome.line()}\n{outcome.output[-500:]}" for outcome in outcomes if outcome.fault()]
    assert not bad, "\n".join(bad)


@pytest.mark.parametrize("name", FOUND)
def test_spoilt_parts_and_large_texts_that_were_once_trouble(malformed, tmp_path, name):
    outcome = malformed.run_case(name, tmp_path)
    assert outcome.fault() is None, f"{outcome.line()}\n{outcome.output[-500:]}"


def test_every_other_one_has_a_file(malformed, tmp_path):
    for name, write in malformed.PARTS.items():
        folder = tmp_path / name
        folder.mkdir()
        assert write(folder).is_file()
    parts, large = set(malformed.PARTS), set(malformed.LARGE)
    assert set(FOUND) <= parts | large and not parts & large


def test_the_same_seed_gives_the_same_file(malformed):
    text = malformed.sources()[0].read_text(encoding="utf-8")
    assert [malformed.malformed(text, seed) for seed in range(40)] == [
        malformed.malformed(text, seed) for seed in range(40)]


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
def test_what_counts_as_a_fault(malformed, code, seconds, memory, output, fault):
    found = malformed.Outcome("truncated", code, seconds, memory, output).fault()
    assert found is None if fault is None else fault in found
