"""The runner of the tests: what runs a second time, and what it then counts."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILES = [str(path.relative_to(ROOT)) for path in sorted((ROOT / "test").glob("test_*.py"))]


@pytest.fixture
def runner(monkeypatch, tmp_path):
    """The script as a module, its output in a folder of the test, and no file really run."""
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    for name in ("run_tests", "run_tests_kinds", "run_tests_processes", "run_tests_results"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    import run_tests
    monkeypatch.setattr(run_tests, "OUT", tmp_path)
    return run_tests


def failed(runner, name):
    return runner.Result(name, failures=[f"{name}: test_a"], output="what it said")


def second(runner, monkeypatch, passed):
    """What runs again comes to this."""
    run = []

    def run_file(file, limit):
        run.append(file)
        name = str(file.relative_to(ROOT))
        return [runner.Result(name, passed=3) if passed else failed(runner, name)]

    monkeypatch.setattr(runner, "run_file", run_file)
    return run


def test_a_file_that_passes_alone_counts_and_is_named(runner, monkeypatch, capsys):
    run = second(runner, monkeypatch, passed=True)
    good = runner.Result("a", passed=2)
    results = runner.run_failed_again([good, failed(runner, FILES[0])], 1.0)
    assert run == [ROOT / FILES[0]] and results[0] is good
    runner.show_outputs(results)
    runner.show_second(results)
    shown = capsys.readouterr().out
    assert "what it said" in shown and f"  {FILES[0]}: test_a\n" in shown
    assert runner.show_totals(results) and capsys.readouterr().out == "5 passed, 0 failed\n"


def test_a_file_that_fails_twice_has_failed(runner, monkeypatch, capsys):
    second(runner, monkeypatch, passed=False)
    results = runner.run_failed_again([failed(runner, FILES[0])], 1.0)
    runner.show_second(results)
    assert capsys.readouterr().out == ""
    runner.show_failed(results)
    assert FILES[0] in capsys.readouterr().out
    assert not runner.show_totals(results)


def test_style_and_many_failures_are_no_accident(runner, monkeypatch):
    run = second(runner, monkeypatch, passed=True)
    style = runner.Result("ruff check", failures=["ruff check"])
    assert runner.run_failed_again([style], 1.0) == [style]
    many = [failed(runner, f"{FILES[0]}{number}") for number in range(runner.MOST_SECOND + 1)]
    assert runner.run_failed_again(many, 1.0) == many
    assert not run
