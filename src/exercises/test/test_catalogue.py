"""exercises.yaml: what is wrong in it is one line with file and key."""

import pytest
import yaml

from exercises.catalogue import find_exercises, read_exercises
from exercises.finding import CannotCheck

GOOD = {"title": "A wall", "start": "a.py", "solution": "b.py", "check": "switch",
        "limits": {"seconds": 1.0}}


def package(folder, entry, name="mine"):
    folder.mkdir(exist_ok=True)
    for file in ("a.py", "b.py"):
        (folder / file).touch()
    file = folder / "exercises.yaml"
    file.write_text(yaml.safe_dump({name: entry} if entry is not None else []), encoding="utf-8")
    return file


def test_a_good_file(tmp_path):
    found = read_exercises(package(tmp_path, GOOD))["mine"]
    assert (found.title, found.start, found.limits) == ("A wall", tmp_path / "a.py",
                                                        {"seconds": 1.0})


@pytest.mark.parametrize(("change", "said"), [
    ({"hint": "x"}, "mine: unknown key 'hint'; there are: title, start"),
    ({"title": ...}, "mine: missing key 'title'"),
    ({"title": 5}, "mine: title: must be a text, is 5"),
    ({"start": "c.py"}, "mine: start: no file "),
    ({"check": "look"}, "mine: check: no check 'look'; there are: action, "),
    ({"limits": {"second": 1}}, "mine: limits: unknown key 'second'; there are: seconds"),
    ({"limits": {}}, "mine: limits: missing key 'seconds'"),
    ({"limits": {"seconds": True}}, "mine: limits: seconds: must be a number, is True"),
    ({"limits": [1]}, "mine: limits: missing key 'seconds'"),
])
def test_what_is_wrong_names_file_and_key(tmp_path, change, said):
    entry = {key: value for key, value in {**GOOD, **change}.items() if value is not ...}
    file = package(tmp_path, entry)
    with pytest.raises(CannotCheck) as error:
        read_exercises(file)
    assert str(error.value).startswith(f"{file}: {said}")


def test_a_file_that_is_no_table(tmp_path):
    with pytest.raises(CannotCheck, match="must be a table of exercises"):
        read_exercises(package(tmp_path, None))
    file = tmp_path / "exercises.yaml"
    file.write_text("a: [", encoding="utf-8")
    with pytest.raises(CannotCheck, match=r"exercises\.yaml: not valid YAML: line 1, column 5: "):
        read_exercises(file)


@pytest.mark.parametrize("text", ["a: 2020-13-45", "a: !!int ''", "a: !!bool x", "[" * 1000])
def test_what_the_yaml_parser_gives_up_on_is_one_line(tmp_path, text):
    (tmp_path / "exercises.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(CannotCheck, match=r"exercises\.yaml: [^\n]{1,300}$"):
        read_exercises(tmp_path / "exercises.yaml")


def test_two_packages_with_one_name(tmp_path):
    folders = {name: tmp_path / name for name in ("one", "two")}
    for folder in folders.values():
        package(folder, GOOD)
    with pytest.raises(CannotCheck, match=r"two/exercises\.yaml: 'mine' is also in .*/one/"):
        find_exercises(folders)
