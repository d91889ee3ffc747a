"""Each exercise: its starting file fails its check, its solution passes; no ROS master here."""

import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml

from exercises.catalogue import find_exercises
from exercises.checks import nodes
from exercises.finding import Mistake
from exercises.main import main

ROOT = Path(__file__).resolve().parents[3]
EXERCISES = find_exercises()
LESSONS = {exercise.start.parents[1] for exercise in EXERCISES.values()}
ANSWERS = yaml.safe_load(Path(__file__).with_name("answers.yaml").read_text(encoding="utf-8"))


def test_the_starting_file_fails_and_the_solution_passes(exercise, begun, capsys):
    start = begun(exercise)
    if start is not None:
        assert main([exercise.name, str(start)]) == 1
        assert "FAIL  " in capsys.readouterr().out
    assert main([exercise.name, str(exercise.solution)]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[-1].startswith("passed, ") and all(" wanted " in line for line in said[1:-1])


@pytest.mark.parametrize(("name", "answer"), [(name, answer) for name, answers in ANSWERS.items()
                                              for answer in answers])
def test_what_learners_may_answer(name, answer, tmp_path, capsys):
    """The solution with one part of it written otherwise; `said`: what is wrong with it."""
    solution = EXERCISES[name].solution
    text = solution.read_text(encoding="utf-8")
    assert text.count(answer["part"]) == 1
    file = tmp_path / solution.name
    file.write_text(text.replace(answer["part"], answer["written"]), encoding="utf-8")
    assert main([name, str(file)]) == ("said" in answer)
    seen = [line for line in capsys.readouterr().out.splitlines() if line.startswith("FAIL")]
    assert "said" not in answer or any(answer["said"] in line for line in seen)


@pytest.mark.parametrize("name", EXERCISES)
def test_rosrun_finds_the_starting_file_and_not_the_solution(name, begun):
    solution = EXERCISES[name].solution
    start = begun(EXERCISES[name]) or EXERCISES[name].start
    assert start.name == solution.name
    assert os.access(start, os.X_OK) == (start.suffix == ".py")
    assert not os.access(solution, os.X_OK)
    if start.suffix == ".py":
        assert start.read_text(encoding="utf-8").startswith("#!/usr/bin/env python3\n")


def test_make_test_does_not_judge_a_learners_unfinished_file():
    """Style and imports: ruff and test_arrows.py leave the starting files alone."""
    ruff = shutil.which("ruff") or "ruff"
    styled = subprocess.run([ruff, "check", "--show-files"], cwd=ROOT, capture_output=True,
                            text=True, check=True).stdout.splitlines()
    walked = {str(path) for path in runpy.run_path(str(ROOT / "test/test_arrows.py"))[
        "python_files"]()}
    for exercise in EXERCISES.values():
        assert str(exercise.start) not in walked.union(styled)
    assert str(ROOT / "src/exercises/src/exercises/main.py") in walked.intersection(styled)


@pytest.mark.parametrize("folder", sorted(LESSONS), ids=lambda folder: folder.name)
@pytest.mark.parametrize("page", ("README.md", "README.zh-CN.md"))
def test_the_lessons_page_has_the_task_the_command_and_hints(folder, page):
    text = (folder / page).read_text(encoding="utf-8")
    own = [name for name, each in EXERCISES.items() if each.start.is_relative_to(folder)]
    typed = re.findall(r"^rosrun exercises check_exercise (\w+)$", text, re.M)
    assert sorted(typed) == sorted(own)
    for name in own:
        behind = text.partition(f"check_exercise {name}\n```\n")[2]
        hints = behind.partition("check_exercise")[0].count("<details><summary>")
        assert behind.startswith("\n<details><summary>") and hints >= 2, name


def test_without_a_name_it_lists_all(capsys):
    assert main([]) == 0
    listed = capsys.readouterr().out
    assert all(f"{name} " in listed and each.title.partition("  ")[0] in listed
               for name, each in EXERCISES.items())


@pytest.mark.parametrize(("language", "said"), [
    ("en", "A controller for each hinge  ("),
    ("zh_CN", "steering       每个转向铰链一个控制器  (")])
def test_titles_are_in_the_terminals_language(capsys, monkeypatch, language, said):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", language)
    assert main([]) == 0
    assert said in capsys.readouterr().out


def test_an_unknown_name_lists_all(capsys):
    assert main(["white_lane"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and all(name in said for name in EXERCISES)
    assert "(did you mean white_line?)" in said


@pytest.mark.parametrize(("text", "said"), [
    (None, "no such file"),
    ("def white_mask(image)\n", ":1: expected ':': def white_mask(image)"),
    ("import no_such_module\n", ":1: ModuleNotFoundError: No module named 'no_such_module'"),
    ("import sys\nsys.exit('no screen')\n", ":2: SystemExit: no screen"),
    ("from __future__ import annotations\nfrom dataclasses import dataclass\n@dataclass\n"
     "class Mask:\n    size: int\n", "has no `white_mask(image)`"),
    ("def mask(image): pass\n", "has no `white_mask(image)`, which the check calls"),
])
def test_what_cannot_be_checked_is_one_line(tmp_path, capsys, text, said):
    file = tmp_path / "mine.py"
    if text is not None:
        file.write_text(text, encoding="utf-8")
    assert main(["white_line", str(file)]) == 2
    error = capsys.readouterr().err
    assert said in error and error.startswith(f"check_exercise: {file}") and error.count("\n") == 1


@pytest.mark.parametrize(("body", "said"), [
    ("exit()", "mine.py:2: SystemExit:"),
    ("1 / 0", "mine.py:2: ZeroDivisionError: division by zero"),
    ("return None", "white_mask(image) answered None, wanted a mask (120, 90)"),
    ("return image", "answered an array (120, 90, 3), wanted a mask (120, 90)"),
])
def test_a_mistake_of_the_program_is_a_failed_check(tmp_path, capsys, body, said):
    (tmp_path / "mine.py").write_text(f"def white_mask(image):\n    {body}\n", encoding="utf-8")
    assert main(["white_line", str(tmp_path / "mine.py")]) == 1
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("FAIL  ") and said in last


def test_a_node_that_has_ended_is_a_mistake():
    child = SimpleNamespace(process=SimpleNamespace(poll=lambda: 1),
                            last_lines=lambda _count: "no turtle here\n")
    with pytest.raises(Mistake, match=r"^mine\.py: ended, exit code 1: no turtle here$"):
        nodes.wait(Path("mine.py"), child, lambda: False, 1.0)


def test_a_loop_without_end_is_one_line(tmp_path):
    (tmp_path / "mine.py").write_text("while True:\n    pass\n", encoding="utf-8")
    code = "import sys, exercises.main as m; m.LIMIT = 1; sys.exit(m.run())"
    done = subprocess.run([sys.executable, "-c", code, "white_line", str(tmp_path / "mine.py")],
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert done.stderr == ("check_exercise: not done after 1 s: does a loop of the program never"
                           " end?\n")


def test_a_check_that_takes_long_says_so(tmp_path):
    (tmp_path / "mine.py").write_text("while True:\n    pass\n", encoding="utf-8")
    code = "import sys, exercises.main as m; m.LONG, m.LIMIT = 0.5, 2; sys.exit(m.run())"
    done = subprocess.run([sys.executable, "-c", code, "white_line", str(tmp_path / "mine.py")],
                          capture_output=True, text=True, timeout=60)
    assert done.stderr.startswith("check_exercise: not done after 0.5 s, and ends after 2 s at the"
                                  " latest; does a loop of the program never end? Ctrl-C")


def hinge(joint, pid):
    """A controllers' file."""
    return f"racecar: {{left: {{type: a/JointPositionController, joint: {joint}, pid: {pid}}}}}"


def test_a_table_that_is_no_controllers_file(tmp_path, capsys):
    file = tmp_path / "mine.yaml"
    for text, code, said in (("a: [", 2, "not valid YAML"), ("a: !!int ''", 2, "not valid YAML"),
                             ("a: 2020-13-45", 2, "not valid YAML"),
                             ("[" * 1000, 2, "not valid YAML"),
                             ("robot: {}", 1, "first key must be `racecar`"),
                             ("racecar: {left: {type: x}}", 1, "left: lacks `joint`"),
                             ("racecar: {left: 3}", 1, "left: lacks `type`"),
                             ("racecar: {left: {type: 3}}", 1, "left: lacks `type`"),
                             (hinge("[a]", "{}"), 1, "left: lacks `joint`"),
                             (hinge("a", "3"), 1, "left: lacks `pid`"),
                             (hinge("a", "{p: 1, i: 0}"), 1, "left: `d` of its `pid` must be"),
                             (hinge("a", "{p: x, i: 0, d: 0}"), 1, "`p` of its `pid` must be"),
                             (hinge("a", "{p: .inf, i: 0, d: 0}"), 1, "`p` of its `pid` must")):
        file.write_text(text, encoding="utf-8")
        assert main(["steering", str(file)]) == code
        assert said in "".join(capsys.readouterr())
