"""The table of what works: well-formed, in the documents as in the data, and with a test each."""

import importlib.util
import re
from pathlib import Path

import pytest

from bullet_sim_ros.interface import InterfaceError, read_interface, rows_by_name

ROOT = Path(__file__).resolve().parent.parent
PLUGINS = ROOT / "src/sim/bullet_sim_ros/src/bullet_sim_ros/plugins"
LIBRARY = re.compile(r'"(lib[\w-]+\.so)"')
REGISTERED = re.compile(r"@plugin\((.*?)\)\s*\nclass", re.DOTALL)


def script(name: str):
    """A file of scripts/ as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "scripts" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


SECTIONS = read_interface()
ROWS = rows_by_name(SECTIONS)


def registered() -> set[str]:
    """Library names that some plugin class takes."""
    return {name for path in PLUGINS.rglob("*.py")
            for block in REGISTERED.findall(path.read_text(encoding="utf-8"))
            for name in LIBRARY.findall(block)}


def test_documents_are_what_the_data_say():
    table = script("interface_table")
    for path, text in table.written(SECTIONS).items():
        assert path.read_text(encoding="utf-8") == text, \
            f"{path.name}: python3 scripts/interface_table.py"


def test_everything_that_works_has_a_test_that_names_it():
    conformance = script("conformance")
    tests = conformance.covered()
    assert conformance.uncovered(SECTIONS, tests) == []
    assert conformance.unknown(SECTIONS, tests) == []


def test_plugins_of_the_table_are_those_of_the_registry():
    supported = {row.name for row in ROWS.values()
                 if row.name.endswith(".so") and row.status != "absent"}
    assert supported == registered()


@pytest.mark.parametrize("text, problem", [
    ("title: T\ntitle_zh: T\nrows: [{name: a, status: fine}]", "a.yaml: 'a': status is 'fine'"),
    ("title: T\ntitle_zh: T\nrows: [{name: a, status: absent}]", "absent needs how and how_zh"),
    ("title: T\ntitle_zh: T\nrows: [{name: a, statu: works}]", "unknown key 'statu'"),
    ("title: T\ntitle_zh: T\nrows: [{name: a, status: works, tags: {b: maybe}}]", "tag 'b'"),
    ("title: T\ntitle_zh: T\nrows: [{name: a, status: works}, {name: a, status: works}]", "twice"),
])
def test_a_bad_file_is_named_with_its_key(tmp_path, text, problem):
    (tmp_path / "a.yaml").write_text(text)
    with pytest.raises(InterfaceError, match=re.escape(problem)):
        read_interface(tmp_path)


def test_a_report_that_was_cut_off_counts_for_nothing(tmp_path):
    (tmp_path / "whole.xml").write_text("<testsuite><testcase name='test_a[b]'/></testsuite>")
    (tmp_path / "cut.xml").write_text("<testsuite><testcase name='test_c'")
    assert script("conformance").outcomes(tmp_path) == {"test_a": "ok"}
