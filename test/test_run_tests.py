"""The runner of the tests: what runs a second time, and what it then counts."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from datetime import date
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
QUICK = "test/test_run_tests.py"  # starts no process
FILES = sorted(str(path.relative_to(ROOT)) for path in ROOT.glob("src/**/test/*.test"))


@pytest.fixture
def runner(monkeypatch, tmp_path):
    """The script as a module, its output in a folder of the test, and no file really run."""
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    for name in ("run_tests", "run_tests_kinds", "run_tests_processes", "run_tests_results",
                 "run_tests_unsteady", "run_tests_fast"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
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


def test_a_file_that_passes_alone_is_forgiven_and_named(runner, monkeypatch, capsys):
    run = second(runner, monkeypatch, passed=True)
    good = runner.Result("a", passed=2)
    results = runner.run_failed_again([good, failed(runner, FILES[0])], 1.0)
    assert run == [ROOT / FILES[0]] and results[0] is good
    runner.show_outputs(results)
    assert runner.judge_unsteady(results, []) == []
    shown = capsys.readouterr().out
    assert "what it said" in shown and f"  {FILES[0]}: test_a\n" in shown
    assert f"UNSTEADY: {FILES[0]}: " in shown
    assert shown.splitlines()[-1] == f"1 unsteady: {FILES[0]}"
    assert runner.show_totals(results) and capsys.readouterr().out == "5 passed, 0 failed\n"


@pytest.mark.parametrize("known", [{}, {"test": "test_a"}])
def test_a_known_file_needs_no_loud_line(runner, monkeypatch, capsys, known):
    second(runner, monkeypatch, passed=True)
    results = runner.run_failed_again([failed(runner, FILES[0])], 1.0)
    runner.judge_unsteady(results, [{"file": FILES[0], **known}])
    assert "UNSTEADY" not in capsys.readouterr().out
    runner.judge_unsteady(results, [{"file": FILES[0], "test": "another"}, {"file": FILES[1]}])
    assert "UNSTEADY" in capsys.readouterr().out


def test_more_than_three_that_are_not_known_fail_the_run(runner, monkeypatch):
    second(runner, monkeypatch, passed=True)
    results = runner.run_failed_again([failed(runner, name) for name in FILES[:4]], 1.0)
    assert runner.judge_unsteady(results, [{"file": FILES[0]}]) == []
    said, *_ = runner.judge_unsteady(results, [])
    assert said.startswith("4 unsteady files that test/unsteady.yaml does not name")


def test_a_file_that_is_unsteady_twice_in_ten_runs_fails_the_second_run(runner, monkeypatch):
    second(runner, monkeypatch, passed=True)
    steady, unsteady = [], runner.run_failed_again([failed(runner, FILES[0])], 1.0)
    known = [{"file": FILES[0]}]
    first, *nine, late = [runner.judge_unsteady(each, []) for each in
                          (unsteady, *[steady] * 9, unsteady)]
    assert first == [] and nine == [[]] * 9 and late == []  # the eleventh
    assert runner.judge_unsteady(unsteady, known) == []
    assert runner.judge_unsteady(unsteady, []) == [f"{FILES[0]}: unsteady twice in 10 runs"]


@pytest.mark.parametrize("fast", [True, False])
def test_a_fast_run_is_none_of_the_ten(runner, monkeypatch, tmp_path, fast):
    for name in ("run_fast", "run_whole"):
        monkeypatch.setattr(runner, name, lambda *_: [])
    monkeypatch.setattr(runner, "run_ruff", lambda: runner.Result("ruff check", passed=1))
    monkeypatch.setattr(runner, "show_conformance", lambda: None)
    monkeypatch.setattr(runner.signal, "signal", lambda *_: None)
    monkeypatch.setattr(runner, "OUT", tmp_path / "out")
    monkeypatch.setattr(sys, "argv", ["run_tests.py", *(["--fast"] if fast else [])])
    assert runner.main() == 0
    assert any((tmp_path / "cache").rglob("unsteady.json")) is not fast


@pytest.mark.parametrize("text", ["", "[[", "a folder", "{}", "7", "[7]", "[[[]]]"])
def test_a_history_that_cannot_be_read_is_none(runner, monkeypatch, tmp_path, text):
    second(runner, monkeypatch, passed=True)
    history = tmp_path / "unsteady.json"
    history.mkdir() if text == "a folder" else history.write_text(text)
    results = runner.run_failed_again([failed(runner, FILES[0])], 1.0)
    assert runner.judge_unsteady(results, [], history) == []


def test_what_starts_no_process_hangs_or_leaves_one_is_not_run_again(runner, monkeypatch):
    run = second(runner, monkeypatch, passed=True)
    hung, left = failed(runner, FILES[0]), failed(runner, FILES[1])
    kinds = sys.modules["run_tests_results"]
    kinds.note_left(hung, 124, [])
    kinds.note_left(left, 1, ["roscore"])
    late = runner.Result(FILES[2])
    late.add_case(ET.fromstring("<testcase name='a' time='1'><failure message='Failed: Timeout "
                                "(>300.0s) from pytest-timeout.'/></testcase>"))
    slow = runner.Result(FILES[3])
    slow.add_case(ET.fromstring("<testcase name='a' time='1'><failure>max time [60.0s] allotted"
                                " for test [a]</failure></testcase>"))
    results = [hung, left, late, slow, failed(runner, QUICK)]
    assert runner.run_failed_again(results, 1.0) == results
    assert not run and not runner.show_totals(results)


def rostest(runner, monkeypatch, tmp_path, code, **files):
    """The result of a file of tests for which rostest leaves these files."""
    def leave(command, log, *_):
        for name, text in files.items():
            (log.parent / f"{name.replace('_', '-')}.xml").write_text(text)
        log.write_text("")
        return code, []

    kinds = sys.modules["run_tests_kinds"]
    monkeypatch.setattr(kinds, "OUT", tmp_path)
    monkeypatch.setattr(kinds, "run_marked", leave)
    return kinds.run_rostest(ROOT / FILES[0], 1.0)


RAN = "<testsuite><testcase name='{}' time='1'>{}</testcase></testsuite>"


def test_a_node_that_was_killed_at_its_time_limit_is_named(runner, monkeypatch, tmp_path):
    killed = "<failure>max time [300.0s] allotted for test [showing]</failure>"
    result = rostest(runner, monkeypatch, tmp_path, 1, rosunit_showing="",
                     rostest_page=RAN.format("testshowing", killed))
    assert result.final and result.failures == [f"{FILES[0]}: testshowing"]


def test_a_node_that_crashed_is_a_failure_although_another_passed(runner, monkeypatch, tmp_path):
    result = rostest(runner, monkeypatch, tmp_path, 0, rosunit_crashed="",
                     rosunit_good=RAN.format("test_it", ""),
                     rostest_page=RAN.format("testcrashed", ""))
    assert result.failures == [
        f"{FILES[0]}: exit code 0, 1 tests ran: rosunit-crashed.xml cannot be read"]


def test_every_test_node_has_the_same_time_limit():
    limits = {(file, node.get("time-limit")) for file in FILES
              for node in ET.parse(ROOT / file).iter("test")}
    assert [each for each in limits if each[1] != "300"] == []


def test_the_list_of_unsteady_files_is_complete_and_fresh(runner):
    for each in runner.read_known():
        assert set(each) - {"test"} == {"file", "reason", "date"}, each
        assert runner.may_run_again(failed(runner, each["file"])), each
        assert isinstance(each["date"], date) and each["reason"]


def test_the_slowest_files_are_shown(runner, capsys):
    runner.show_slowest([runner.Result(f"a{number}.py", seconds=number) for number in range(12)])
    assert capsys.readouterr().out.splitlines()[2:4] == ["   11.0 s  a11.py", "   10.0 s  a10.py"]


def test_a_file_that_fails_twice_has_failed(runner, monkeypatch, capsys):
    second(runner, monkeypatch, passed=False)
    results = runner.run_failed_again([failed(runner, FILES[0])], 1.0)
    assert runner.judge_unsteady(results, []) == [] and capsys.readouterr().out == ""
    runner.show_failed(results)
    assert FILES[0] in capsys.readouterr().out
    assert not runner.show_totals(results)


def test_of_a_pytest_file_only_what_failed_runs_again(runner, monkeypatch, capsys):
    name, asked = "src/evaluation/test/test_course_run.py", []

    def run_pytest_file(file, limit, tests):
        asked.append((file, tests))
        return runner.Result(name, passed=1, skips=["no sound"])

    monkeypatch.setattr(runner, "run_pytest_file", run_pytest_file)
    first = runner.Result(name, passed=4, skips=["no GPU"])
    first.add_case(ET.fromstring("<testcase name='test_a[b c]' time='1'><failure/></testcase>"))
    (result,) = runner.run_failed_again([first], 1.0)
    assert asked == [(ROOT / name, ["test_a[b c]"])]
    assert (result.passed, result.skips, result.failures) == (
        5, ["no GPU", "no sound"], [])
    assert result.first_failures == [f"{name}: test_a[b c]"]


def test_pytest_that_ends_without_its_report_has_failed(runner, tmp_path, capsys):
    """Killed while it wrote it, or ended by a test: nobody knows what passed."""
    results = sys.modules["run_tests_results"]
    (tmp_path / "cut.xml").write_text("<testsuites><testsuite><testcase name='a' file='f.py'")
    for report in ("cut.xml", "none.xml"):
        files = results.pytest_cases(tmp_path / report)
        whole = runner.Result("pytest")
        results.note_end(whole, 0, files.values(), [])
        assert (files, whole.failures) == ({}, ["pytest: ended with exit code 0"])


def test_only_what_was_left_for_want_of_time_counts_as_that(runner, monkeypatch, capsys):
    case = "<testcase name='{0}' time='1'><skipped message='{0}'/></testcase>"
    some = runner.Result("test/test_a.py")
    for message in ("left for make test", "no GPU"):
        some.add_case(ET.fromstring(case.format(message)))
    monkeypatch.setattr(runner, "fast_groups", lambda slow: [[ROOT / QUICK]])
    monkeypatch.setattr(runner, "run_pytest", lambda *_: [some])
    monkeypatch.setenv(runner.UNTIL, "0")
    runner.run_fast([])
    assert "and 1 tests that had not begun" in capsys.readouterr().out and len(some.skips) == 2


def test_every_reason_to_skip_is_shown_with_its_number(runner, capsys):
    results = [runner.Result("a.py"), runner.Result("b.py", passed=1)]
    for result, skipped in zip([*results, results[0]], (
            '<skipped message="no GPU"/>', '<skipped message="no &#10; GPU"/>',
            '<skipped message=" "/>'),
            strict=True):
        result.add_case(ET.fromstring(f"<testcase name='test' time='1'>{skipped}</testcase>"))
    runner.show_skipped(results)
    assert runner.show_totals(results)
    assert capsys.readouterr().out == (
        "\nSkipped:\n    2  no GPU\n    1  no reason given\n1 passed, 0 failed, 3 skipped\n")
    runner.show_skipped([])
    assert capsys.readouterr().out == ""


def test_interrupted_in_the_second_run_it_says_so_and_counts_nothing(
        runner, monkeypatch, capsys, tmp_path):
    def run_again(results, limit):
        runner.processes.stop(2, None)
        return results

    for name, found in (("run_ruff", runner.Result("ruff check", passed=1)), ("run_whole", [])):
        monkeypatch.setattr(runner, name, lambda *_, found=found: found)
    monkeypatch.setattr(runner, "run_failed_again", run_again)
    monkeypatch.setattr(runner, "show_conformance", lambda: None)
    monkeypatch.setattr(runner.signal, "signal", lambda *_: None)
    monkeypatch.setattr(sys, "argv", ["run_tests.py"])
    assert runner.main() == 130
    assert "passed" not in capsys.readouterr().out


def test_a_process_is_named_whatever_its_words_are(runner):
    waits = [sys.executable, "-c", "import sys; print(flush=True); sys.stdin.read()", b"\xff"]
    with subprocess.Popen(waits, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout.readline()  # it runs: until then it may have no words
        assert runner.processes.command_line(process.pid).endswith("\N{REPLACEMENT CHARACTER}")


def test_style_and_many_failures_are_no_accident(runner, monkeypatch):
    run = second(runner, monkeypatch, passed=True)
    style = runner.Result("ruff check", failures=["ruff check"])
    assert runner.run_failed_again([style], 1.0) == [style]
    many = [failed(runner, f"{FILES[0]}{number}") for number in range(runner.MOST_SECOND + 1)]
    assert runner.run_failed_again(many, 1.0) == many
    assert not run


def test_fast_takes_changed_tests_early_and_no_file_with_processes(runner):
    import run_tests_fast as fast
    package = ROOT / "src/navigation/map_server"
    apart = set(runner.files_that_say(runner.PROCESSES, "test_*.py"))
    changed = [package / "test/test_map_files.py", package / "src/map_server/errors.py",
               ROOT / "Makefile"]
    always = [ROOT / "test/test_arrows.py", ROOT / "test/test_docstrings.py"]
    core = [ROOT / "src/sim/bullet_sim", ROOT / "src/navigation/nav_algorithms"]
    first, *groups = fast.choose(changed, apart)
    assert first == [*always, changed[0]]
    assert [{path.parents[1] for path in group} for group in groups] == [
        {home} for home in (package, ROOT, *core)]
    files = sum(groups, first)
    assert len(set(files)) == len(files) and not apart & set(files)
    unchanged = fast.choose([], apart)
    assert unchanged == [always, *groups[2:]]


def test_low_priority_is_of_the_command_alone(runner, tmp_path):
    """As root and as an ordinary user, whether or not Linux groups by session."""
    go = tmp_path / "go"  # is there when the priority has been set
    says = (f"import os, time\nwhile not os.path.exists({str(go)!r}): time.sleep(0.01)\n"
            "print(os.nice(0)); "
            "group = '/proc/self/autogroup'; print(os.path.exists(group) and open(group).read())")
    command = [sys.executable, "-c", says]
    wanted = runner.processes.LOW_PRIORITY
    for low in (True, True, False):
        go.unlink(missing_ok=True)
        code, _ = runner.processes.run_marked(
            command, tmp_path / "log", 60.0, lambda _log: go.touch(), low)
        nice, group = (tmp_path / "log").read_text().splitlines()[:2]
        assert code == 0 and int(nice) == min(19, os.nice(0) + (wanted if low else 0))
        assert "nice" not in group or int(group.split()[-1]) == (wanted if low else 0)
