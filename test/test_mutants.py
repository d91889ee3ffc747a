"""What `make mutants` changes, which tests it runs, and what its command refuses."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
MUTANTS = Path(__file__).parent / "mutants"
NOISE = "src/sim/bullet_sim/src/bullet_sim/sensors/noise.py"
TESTS = "src/sim/bullet_sim/test/test_sensor_errors.py"
QUANTIZED = f"{TESTS}::test_only_quantized_readings_come_in_steps"
LEVEL = f"{TESTS}::test_an_accelerometers_bias_tilts_by_its_share_of_gravity"
TRY = """
import json, sys
from changes import ROOT, mutants
from trying import outcome
path, test = ROOT / sys.argv[1], sys.argv[2]
(mutant,) = [each for each in mutants("sensors", path) if "Eq_NotEq" in each.operator]
print(json.dumps(outcome(mutant, [{test: 0.1}])))
"""


@pytest.fixture(scope="module")
def mutants(modules):
    return modules("mutants", "changes", "mutants", "recording")


def changed(mutants, path, text):
    path.write_text(text)
    return [mutant for mutant in mutants["changes"].mutants("sensors", path) if mutant.runs()]


def test_changes_are_of_what_is_done_not_of_what_is_annotated(mutants, tmp_path):
    found = changed(mutants, tmp_path / "f.py", "def f(a: int | None) -> bool | int:\n"
                                                "    return a < 2 and not a * 3\n")
    after = {mutant.lines[1] for mutant in found}
    assert {"return a <= 2 and not a * 3", "return a < 2 or not a * 3",
            "return a < 2 and not a / 3", "return a < 2 and a * 3",
            "return a < 3 and not a * 3"} <= after
    assert {mutant.line for mutant in found} == {2}
    assert "return a < 2 and not a << 3" not in after  # no operation of floats
    assert len({mutant.source for mutant in found}) == len(found)


def test_a_seed_is_a_sample_of_one_change_at_a_place(mutants, tmp_path, monkeypatch):
    (tmp_path / "f.py").write_text("a, b = 1, c < 3\nd = e and not f\n")
    monkeypatch.setattr(mutants["changes"], "PACKAGES", {"sensors": tmp_path})
    first, again, *others = [[(each.line, each.column, each.source)
                              for each in mutants["changes"].drawn(seed)] for seed in (1, 1, 2, 3)]
    assert first == again and others != [first, first]
    for sample in (first, *others):
        assert sorted(each[:2] for each in sample) == [(1, 7), (1, 12), (1, 14), (2, 6), (2, 10)]


def test_what_is_said_to_be_equal_is_in_the_code(mutants):
    rows = mutants["changes"].yaml.safe_load((MUTANTS / "equal.yaml").read_text("utf-8"))
    for row in rows["single"]:
        (path,) = [path for folder in mutants["changes"].PACKAGES.values()
                   for path in folder.rglob("*.py") if str(path).endswith("/" + row["file"])]
        lines = " ".join(path.read_text("utf-8").split())
        assert row["before"] in lines and row["before"] != row["after"] and row["why"], row


def test_an_equal_change_is_known_by_its_lines(mutants, tmp_path):
    file = tmp_path / "equal.yaml"
    file.write_text("kinds: [{before: '@cache', after: '', why: speed}]\nsingle:\n"
                    "- {file: f.py, before: 'a = 1', after: 'a = 2', why: unused}\n")
    why = mutants["changes"].Equal(file).why
    found = changed(mutants, tmp_path / "f.py", "@cache\ndef f():\n    a = 1\n    return g()\n")
    assert {mutant.lines[1]: why(mutant) for mutant in found} == {
        "": "speed", "a = 2": "unused", "a = 0": None}


def test_tests_that_run_a_line_are_shown_its_change_the_short_ones_first(mutants):
    changes = mutants["changes"]
    line = next(each.line for each in changes.mutants("sensors", changes.ROOT / NOISE))
    mutant = next(each for each in changes.mutants("sensors", changes.ROOT / NOISE)
                  if each.line == line)
    contexts = {str(line): ["", "t.py::long", "t.py::short", "u.py"], "1": ["t.py::other"]}
    recorded = mutants["recording"].Recording({
        "stamp": "", "failed": ["t.py::failed"], "lines": {NOISE: contexts},
        "seconds": {"t.py::long": 9.0, "t.py::short": 0.1, "t.py::failed": 0.1,
                    "t.py::other": 0.2, "u.py::shares": 1.0, "v.py::else": 1.0}})
    first, second = recorded.groups(mutant, first=2)
    names = [*first, *second]
    assert names[0] == "t.py::short" and names[-1] == "t.py::long"
    assert "u.py::shares" in names and not {"t.py::failed", "v.py::else"} & set(names)


@pytest.mark.parametrize("test, told", [(QUANTIZED, ["noticed", QUANTIZED]),
                                        (LEVEL, ["unnoticed", ""])])
def test_a_change_is_noticed_by_a_test_of_it_alone(test, told):
    done = subprocess.run([sys.executable, "-c", TRY, NOISE, test], cwd=MUTANTS, text=True,
                          capture_output=True, timeout=120)
    assert json.loads(done.stdout) == told, done.stderr


def test_what_nobody_noticed_is_tried_again_with_other_tests(mutants, tmp_path):
    kept = mutants["mutants"].Kept
    one, two = changed(mutants, tmp_path / "f.py", "a = 1\n")
    changes = mutants["changes"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(changes, "ROOT", tmp_path)
        kept(tmp_path / "results").add(one, "tests", "unnoticed", "")
        kept(tmp_path / "results").add(two, "tests", "noticed", "t.py::t")
        (tmp_path / "results").open("a").write('{"key": "half')
        found = kept(tmp_path / "results")
        assert [found.known(one, "tests"), found.known(two, "tests")] == ["unnoticed", "noticed"]
        assert [found.known(one, "others"), found.known(two, "others")] == [None, "noticed"]


@pytest.mark.parametrize("words, said", [
    (["--sample", "0"], "--sample (SAMPLE=) must be a whole number, 1 to "),
    (["--seed", "x"], "--seed (SEED=) must be a whole number"), (["--loud"], "scripts/mutants.sh")])
def test_a_mistake_is_one_line(words, said):
    done = subprocess.run([sys.executable, MUTANTS / "mutants.py", *words], capture_output=True,
                          text=True, timeout=120)
    assert done.returncode == 2 and said in done.stderr and done.stderr.count("\n") == 1
