"""The runner of the tests: what becomes of a file of tests, what runs again, and what it counts."""

import os
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
QUICK = "test/test_run_tests.py"  # starts no process
FILES = sorted(str(path.relative_to(ROOT)) for path in ROOT.glob("src/**/test/*.test"))
APART = {ROOT / name for name in FILES}


@pytest.fixture
def runner(monkeypatch, tmp_path):
    """The script as a module; its tree, its output and the user's cache are the test's."""
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    for name in ("run_tests", "run_tests_files"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    import run_tests
    monkeypatch.setattr(run_tests.files, "OUT", tmp_path / "out")
    monkeypatch.setattr(run_tests, "OUT", tmp_path / "out")
    monkeypatch.setattr(run_tests, "KEPT", tmp_path / "cache" / "tests.json")
    return run_tests


def failing(runner, name, text="it failed"):
    case = runner.Case(name, "test_a", "failed", text, 1.0)
    return runner.Result(name, [case], output="what it said")


def passing(runner, name):
    return runner.Result(name, [runner.Case(name, f"test_{each}", "passed", "", 0.0)
                                for each in "abc"])


def second(runner, monkeypatch, make):
    """What runs again comes to what `make` makes; the files that did."""
    run = []

    def run_alone(path, tests=()):
        run.append((str(path.relative_to(ROOT)), list(tests)))
        return make(runner, run[-1][0])

    monkeypatch.setattr(runner, "run_alone", run_alone)
    return run


def again(runner, *results):
    return runner.run_failed_again(list(results), APART)


def test_a_file_that_passes_alone_is_forgiven_and_named(runner, monkeypatch, capsys):
    run = second(runner, monkeypatch, passing)
    good = passing(runner, "a.py")
    results = again(runner, good, failing(runner, FILES[0]))
    assert run == [(FILES[0], [])] and results[0] is good
    runner.show_outputs(results)
    assert runner.judge_unsteady(results, [], []) == ([FILES[0]], [])
    shown = capsys.readouterr().out
    assert "what it said" in shown and f"  {FILES[0]}: test_a\n" in shown
    assert f"UNSTEADY: {FILES[0]}: " in shown
    assert shown.splitlines()[-1] == f"1 unsteady: {FILES[0]}"
    assert runner.show_totals(results) and capsys.readouterr().out == "6 passed, 0 failed\n"


def test_an_unsteady_file_is_named_with_its_reason(runner, capsys):
    text = "    def test_a():\n>       assert 901 == 902\nE       assert 901 == 902\nE        more"
    first = runner.Result(FILES[0], [runner.Case(FILES[0], "test_a", "failed", text, 0.0)])
    runner.judge_unsteady([replace(passing(runner, FILES[0]), first=first)], [], [])
    assert f"  {FILES[0]}: test_a\n    E       assert 901 == 902\nUN" in capsys.readouterr().out


@pytest.mark.parametrize("known", [{}, {"test": "test_a"}])
def test_a_known_file_needs_no_loud_line(runner, monkeypatch, capsys, known):
    second(runner, monkeypatch, passing)
    results = again(runner, failing(runner, FILES[0]))
    assert runner.judge_unsteady(results, [{"file": FILES[0], **known}], []) == ([], [])
    assert "UNSTEADY" not in capsys.readouterr().out
    runner.judge_unsteady(results, [{"file": FILES[0], "test": "another"}, {"file": FILES[1]}], [])
    assert "UNSTEADY" in capsys.readouterr().out


def test_more_than_three_that_are_not_known_fail_the_run(runner, monkeypatch):
    second(runner, monkeypatch, passing)
    results = again(runner, *(failing(runner, name) for name in FILES[:4]))
    assert runner.judge_unsteady(results, [{"file": FILES[0]}], [])[1] == []
    said, = runner.judge_unsteady(results, [], [])[1]
    assert said.startswith("4 unsteady files that test/unsteady.yaml does not name")


def test_a_file_that_is_unsteady_twice_in_ten_runs_fails_the_second_run(runner, monkeypatch):
    second(runner, monkeypatch, passing)
    results = again(runner, failing(runner, FILES[0]))
    twice = [f"{FILES[0]}: unsteady twice in 10 runs"]
    runner.keep(runner.KEPT, runner.Kept(unsteady=[[FILES[0]], *[[]] * 8]))
    assert runner.judge_unsteady(results, [], runner.read_kept(runner.KEPT).unsteady)[1] == twice
    assert runner.judge_unsteady(results, [{"file": FILES[0]}], [[FILES[0]]])[1] == []
    runner.keep(runner.KEPT, runner.Kept(unsteady=[[FILES[0]], *[[]] * 9]))  # this is the eleventh
    assert runner.judge_unsteady(results, [], runner.read_kept(runner.KEPT).unsteady)[1] == []


@pytest.mark.parametrize("text", ["", "[[", "a folder", "{}", "7", "[7]", '{"seconds": [1]}',
                                  '{"seconds": {"a.py": "long"}, "unsteady": []}'])
def test_what_was_kept_and_cannot_be_read_is_nothing(runner, text):
    kept = runner.KEPT
    kept.parent.mkdir(parents=True)
    kept.mkdir() if text == "a folder" else kept.write_text(text)
    assert runner.read_kept(kept) == runner.Kept()
    some = runner.Kept({"a.py": 1.0}, {"a.py": 2.0}, [["b.py"]])
    runner.keep(kept, some)
    assert runner.read_kept(kept) == (runner.Kept() if text == "a folder" else some)


def test_what_was_kept_before_processor_seconds_were_is_read(runner):
    runner.KEPT.parent.mkdir(parents=True)
    runner.KEPT.write_text('{"seconds": {"a.py": 1.0}, "unsteady": [["b.py"]]}')
    assert runner.read_kept(runner.KEPT) == runner.Kept({"a.py": 1.0}, {}, [["b.py"]])


def test_what_starts_no_process_hangs_or_leaves_one_is_not_run_again(runner, monkeypatch):
    run = second(runner, monkeypatch, passing)
    hung, left = passing(runner, FILES[0]), failing(runner, FILES[1])
    hung.problems, left.problems = ["not done in time"], ["left running: roscore"]
    late = failing(runner, FILES[2], "Failed: Timeout (>300.0s) from pytest-timeout.")
    slow = failing(runner, FILES[3], "max time [60.0s] allotted for test [a]")
    results = [hung, left, late, slow, failing(runner, QUICK)]
    assert again(runner, *results) == results
    assert not run and not runner.show_totals(results)


def test_a_file_that_fails_twice_has_failed(runner, monkeypatch, capsys):
    second(runner, monkeypatch, failing)
    results = again(runner, failing(runner, FILES[0]))
    assert runner.judge_unsteady(results, [], []) == ([], []) and capsys.readouterr().out == ""
    assert not runner.show_totals(results)
    assert f"Failed:\n  {FILES[0]}: test_a\n" in capsys.readouterr().out


def test_many_failures_are_no_accident(runner, monkeypatch):
    run = second(runner, monkeypatch, passing)
    many = [failing(runner, name) for name in FILES[:runner.MOST_SECOND + 1]]
    assert again(runner, *many) == many and not run


def test_of_a_pytest_file_only_what_failed_runs_again(runner, monkeypatch):
    name = "src/evaluation/test/test_course_run.py"
    run = second(runner, monkeypatch, lambda runner, name: runner.Result(
        name, [runner.Case(name, "test_a[b c]", "passed", "", 0.0)]))
    first = passing(runner, name)
    first.cases.append(runner.Case(name, "test_a[b c]", "failed", "", 0.0))
    result, = runner.run_failed_again([first], {ROOT / name})
    assert run == [(name, ["test_a[b c]"])]
    assert (len(result.those("passed")), result.failures) == (4, [])
    assert result.first.failures == [f"{name}: test_a[b c]"]


def test_the_list_of_unsteady_files_is_complete_and_fresh(runner):
    apart = APART | runner.files_that_say(runner.PROCESSES, "test_*.py")
    for each in yaml.safe_load((ROOT / "test" / "unsteady.yaml").read_text()) or []:
        assert set(each) - {"test"} == {"file", "reason", "date"}, each
        assert runner.may_run_again(failing(runner, each["file"]), apart), each
        assert isinstance(each["date"], date) and each["reason"]


def test_the_slowest_files_are_shown_and_what_grew_most(runner, capsys):
    seconds = {f"a{each}.py": float(each) for each in range(12)}
    before = {"a3.py": 1.0, "a4.py": 3.5, "a5.py": 9.0}
    half = {name: number / 2 for name, number in seconds.items()}
    runner.show_seconds(seconds, half, runner.Kept(before, {"a3.py": 0.5, "a5.py": 9.0}))
    lists = capsys.readouterr().out.strip().split("\n\n")
    slowest, grown, processor, grown_processor = (each.splitlines() for each in lists)
    assert slowest[1:3] == ["     11.0 s  a11.py", "     10.0 s  a10.py"] and len(slowest) == 11
    assert grown[1:] == ["     +2.0 s  a3.py", "     +0.5 s  a4.py"]
    assert processor[:2] == ["Most of 33 processor seconds:", "      5.5 s  a11.py"]
    assert grown_processor[1:] == ["     +1.0 s  a3.py"]


def test_processor_seconds_are_a_files_tests_and_what_these_started(runner, tmp_path):
    """In a run of many files, and of a file that has a process of its own."""
    (tmp_path / "many.xml").write_text("<testsuite>" + "".join(
        f"<testcase file='{file}' name='{test}'><properties><property name='processor' value="
        f"'{used}'/></properties></testcase>"
        for file, test, used in (("a.py", "b", 1.25), ("a.py", "c", 2.5), (FILES[0], "whole", 7.5))
    ) + "</testsuite>")
    cases, _ = runner.files.read_cases(tmp_path)
    found = {each.name: each for each in runner.results_of(runner.Result("many", cases))}
    assert (found["a.py"].processor, found[FILES[0]].processor) == (3.75, 7.5)
    assert not found[FILES[0]].problems


def test_every_reason_to_skip_is_shown_with_its_number(runner, capsys, tmp_path):
    (tmp_path / "a.xml").write_text(
        "<testsuite><testcase name='a'><skipped message='no GPU'/></testcase>"
        "<testcase name='b'><skipped message='no &#10; GPU'/></testcase>"
        "<testcase name='c'><skipped message=' '/></testcase><testcase name='d'/></testsuite>")
    cases, _ = runner.files.read_cases(tmp_path)
    assert runner.show_totals([runner.Result("a.py", cases)])
    assert capsys.readouterr().out == (
        "\nSkipped:\n      2  no GPU\n      1  no reason given\n1 passed, 0 failed, 3 skipped\n")
    assert not runner.show_totals([])
    assert capsys.readouterr().out == "0 passed, 0 failed\n"


def ended(runner, folder, code, **reports):
    """What is wrong with a command that leaves these reports."""
    for name, text in reports.items():
        (folder / f"{name.replace('_', '-')}.xml").write_text(text)
    return runner.files.ending(code, [], folder)


RAN = "<testsuite><testcase name='{}' time='1'>{}</testcase></testsuite>"


def test_a_node_that_was_killed_at_its_time_limit_is_named(runner, tmp_path):
    killed = "<failure>max time [300.0s] allotted for test [showing]</failure>"
    assert ended(runner, tmp_path, 1, rosunit_showing="",
                 rostest_page=RAN.format("testshowing", killed)) == []
    result = runner.Result(FILES[0], runner.files.read_cases(tmp_path)[0])
    assert result.failures == [f"{FILES[0]}: testshowing"]
    assert not runner.may_run_again(result, APART)


def test_a_node_that_crashed_is_a_failure_although_another_passed(runner, tmp_path):
    assert ended(runner, tmp_path, 0, rosunit_crashed="",
                 rosunit_good=RAN.format("test_it", ""),
                 rostest_page=RAN.format("testcrashed", "")) == [
        "exit code 0, 1 tests ran: rosunit-crashed.xml cannot be read"]


def test_what_ends_without_its_report_has_failed(runner, tmp_path):
    """Killed while it wrote it, or ended by a test: nobody knows what passed."""
    assert ended(runner, tmp_path, 0) == ["exit code 0, 0 tests ran"]
    assert ended(runner, tmp_path, 0, cut="<testsuites><testsuite><testcase name='a'") == [
        "exit code 0, 0 tests ran: cut.xml cannot be read"]


def test_every_test_node_has_the_usual_time_limit_or_twice_that():
    limits = {(file, node.get("time-limit")) for file in FILES
              for node in ET.parse(ROOT / file).iter("test")}
    assert [each for each in limits if each[1] not in ("300", "600")] == []


def test_fast_takes_changed_packages_and_the_list(runner):
    package = ROOT / "src/navigation/map_server"
    plain = runner.files_that_say(runner.ANY, "test_*.py") - runner.files_that_say(
        runner.PROCESSES, "test_*.py")
    unchanged = runner.fast_files([], plain)
    assert ROOT / "test/test_style.py" in unchanged
    listed = yaml.safe_load(runner.FAST.read_text())
    assert unchanged == {ROOT / folder / name for folder in listed for name in listed[folder]}
    assert runner.fast_files([ROOT / "Makefile", ROOT / "test/fast.yaml"], plain) == unchanged
    changed = runner.fast_files([package / "src/map_server/errors.py"], plain) - unchanged
    assert changed == set(package.glob("test/**/test_*.py")) & plain
    soak = ROOT / "test/test_soak.py"
    assert runner.fast_files([soak, ROOT / "test/test_fuzz.py"], plain) == unchanged | {soak}


def whole_run(runner, monkeypatch, *words):
    """Exit code of the runner with these words; no file is really run."""
    result = passing(runner, "a.py")
    monkeypatch.setattr(runner, "run_pytest", lambda *_, **options: [result])
    monkeypatch.setattr(runner, "run_alone", lambda path: result)
    monkeypatch.setattr(runner.signal, "signal", lambda *_: None)
    monkeypatch.setattr(runner.subprocess, "run", lambda *_, **options:
                        runner.subprocess.CompletedProcess([], 1))
    monkeypatch.setattr(sys, "argv", ["run_tests.py", *words])
    return runner.main()


@pytest.mark.parametrize("words", [["--fast"], []])
def test_a_fast_run_is_none_of_the_ten(runner, monkeypatch, words):
    assert whole_run(runner, monkeypatch, *words) == 0
    kept = runner.read_kept(runner.KEPT)
    assert kept.seconds == kept.processor == {"a.py": 0.0}
    assert kept.unsteady == ([] if words else [[]])


def test_interrupted_in_the_second_run_it_says_so_and_counts_nothing(runner, monkeypatch, capsys):
    def run_again(results, apart):
        runner.stop(2, None)
        return results

    monkeypatch.setattr(runner, "run_failed_again", run_again)
    assert whole_run(runner, monkeypatch) == 130
    said = capsys.readouterr()
    assert "passed" not in said.out and "interrupted" in said.err
    assert runner.second_run(first := failing(runner, FILES[0])) is first


def test_a_process_is_named_whatever_its_words_are(runner, tmp_path):
    code = f"""if True:
        import subprocess
        words = [{sys.executable!r}, "-c", "print(flush=True); input()", b"\\xff"]
        wait = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        wait.stdout.readline()  # it runs: until then it may have no words
        subprocess.Popen(["tail", "-f", "/dev/null", f"--pid={{wait.pid}}"], stdin=wait.stdin)
        """
    code, left = runner.files.run_marked([sys.executable, "-c", code], tmp_path / "log")
    assert code == 0 and any("input()" in each for each in left), left


def test_low_priority_is_of_the_command_alone(runner, tmp_path):
    """As root and as an ordinary user, whether or not Linux groups by session."""
    says = ("import os; print(os.nice(0)); "
            "group = '/proc/self/autogroup'; print(os.path.exists(group) and open(group).read())")
    for low in (runner.GIVE_WAY, ()):
        code, _ = runner.files.run_marked([*low, sys.executable, "-c", says], tmp_path / "log")
        nice, group = (tmp_path / "log").read_text().splitlines()[:2]
        wanted = 5 if low else 0
        assert code == 0 and int(nice) == min(19, os.nice(0) + wanted)
        assert "nice" not in group or int(group.split()[-1]) == wanted


def test_a_file_of_which_no_test_ran_is_a_failure(runner, monkeypatch):
    report = ('<testsuites><testsuite><testcase file="test/test_common.py" name="test_a"/>'
              '</testsuite></testsuites>')
    runner.OUT.mkdir(parents=True)

    def run_marked(command, log, *_):
        log.touch()
        log.with_name("pytest.xml").write_text(report)
        return 0, []

    monkeypatch.setattr(runner.files, "run_marked", run_marked)
    paths = [ROOT / "test/test_common.py", ROOT / QUICK]
    results = runner.run_pytest("without processes", paths)
    assert [each for result in results for each in result.failures] == [
        f"{QUICK}: none of its tests ran"]


def test_a_named_file_that_is_no_file_of_tests_is_refused(runner, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["run_tests.py", QUICK, "test/test_none.py"])
    with pytest.raises(SystemExit) as end:
        runner.main()
    assert end.value.code == 2
    assert "test/test_none.py: no file of tests" in capsys.readouterr().err
