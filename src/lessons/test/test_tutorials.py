"""The tutorials' pages, row by row: what a page has, and what must be seen here (tutorials*.yaml).

`python3 -m pytest -v src/lessons/test/test_tutorials.py` prints the table with results.
"""

import ast
import re
import subprocess
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import pytest
import roslaunch.config
import roslaunch.xmlloader
import rospkg
import yaml

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
PAGES = {page: rows for file in sorted(HERE.glob("tutorials*.yaml"))
         for page, rows in yaml.safe_load(file.read_text(encoding="utf-8")).items()}
TYPED = yaml.safe_load((HERE / "lesson_commands.yaml").read_text(encoding="utf-8"))
ROWS = [pytest.param(row, id=f"{page}: {row['page']}")
        for page, rows in PAGES.items() for row in rows]
PACKAGES = rospkg.RosPack()


def path_of(place: str) -> Path:
    """PACKAGE/FILE, where rospack finds the package."""
    package, _, file = place.partition("/")
    return Path(PACKAGES.get_path(package)) / file


def check_file(row: dict) -> None:
    path = path_of(row["file"])
    assert path.exists(), f"no {path}"
    for pattern in row.get("has", []):
        assert re.search(pattern, path.read_text(encoding="utf-8")), f"{path} has no /{pattern}/"


def check_code(row: dict) -> None:
    """Each snippet is a statement or an expression of the script, however it is laid out."""
    tree = ast.parse(path_of(row["file"]).read_text(encoding="utf-8"))
    there = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, (ast.stmt, ast.expr))}
    for snippet in row["code"]:
        try:
            wanted = ast.parse(snippet, mode="eval")
        except SyntaxError:
            wanted = ast.parse(snippet)  # a statement
        assert ast.unparse(wanted) in there, f"{row['file']} has no `{snippet}`"


def check_launch(row: dict) -> None:
    place, *arguments = row["launch"].split()
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(str(path_of(place)), config, argv=arguments,
                                         verbose=False)
    nodes = {node.namespace + node.name: node for node in config.nodes}
    for name, wanted in row.get("nodes", {}).items():
        assert name in nodes, f"no {name}, but {sorted(nodes)}"
        node = nodes[name]
        seen = " ".join([node.package, node.type, node.args or "",
                         *(f"{old}:={new}" for old, new in node.remap_args)])
        assert re.search(wanted, seen), f"{name} is {seen}"
    for name in row.get("clears", []):
        assert name in config.clear_params, f"{name} is not cleared, but {config.clear_params}"
    for name, value in row.get("params", {}).items():
        assert name in config.params, f"no parameter {name}"
        assert config.params[name].value == value, f"{name} is {config.params[name].value!r}"


@cache
def robot(path: Path) -> ElementTree.Element:
    if path.suffix != ".xacro":
        return ElementTree.parse(path).getroot()
    done = subprocess.run(["rosrun", "xacro", "xacro", str(path)], check=True, text=True,
                          capture_output=True)
    return ElementTree.fromstring(done.stdout)


def check_robot(row: dict) -> None:
    model = robot(path_of(row["robot"]))
    for name in row.get("links", []):
        assert model.find(f"link[@name='{name}']") is not None, f"no link {name}"
    for name, (kind, *offset) in row.get("joints", {}).items():
        joint = model.find(f"joint[@name='{name}']")
        assert joint is not None, f"no joint {name}"
        assert joint.get("type") == kind
        assert [float(word) for word in joint.find("origin").get("xyz").split()] == \
            pytest.approx(offset), name
    for place, value in row.get("values", {}).items():
        element, attribute = re.fullmatch(r"(.*?)(?:@(\w+))?", place).groups()
        found = [each.get(attribute) if attribute else each.text for each in model.findall(element)]
        assert str(value) in found, f"{place} is {found}"


def check_yaml(row: dict) -> None:
    table = yaml.safe_load(path_of(row["yaml"]).read_text(encoding="utf-8"))
    for keys, value in row["values"].items():
        found = table
        for key in keys.split("/"):
            found = found[key]
        assert found == value, f"{keys} is {found!r}"


def check_typed(row: dict) -> None:
    """test_lesson_commands.py types it in a real terminal and looks at what it shows."""
    steps = [step["type"] for scenarios in TYPED.values() if isinstance(scenarios, list)
             for scenario in scenarios for step in scenario.get("terminals", [])]
    commands = row["typed"] if isinstance(row["typed"], list) else [row["typed"]]
    for command in commands:
        assert command in steps, f"nobody types `{command}`"


def check_tested(row: dict) -> None:
    path = REPOSITORY / row["tested"]
    assert path.is_file(), f"no {path}"
    text = path.read_text(encoding="utf-8")
    for pattern in row["by"]:
        assert re.search(pattern, text), f"{path} has no /{pattern}/"


def check_wrong(row: dict) -> None:
    """A line of the package's README, in both languages, says what is wrong on the page."""
    for readme, pattern in zip(("README.md", "README.zh-CN.md"), row["wrong"]):
        text = " ".join(path_of(f"{row['readme']}/{readme}").read_text(encoding="utf-8").split())
        assert re.search(pattern, text), f"{row['readme']}/{readme} has no /{pattern}/"


CHECKS = {"file": check_file, "code": check_code, "launch": check_launch, "robot": check_robot,
          "yaml": check_yaml, "typed": check_typed, "tested": check_tested, "wrong": check_wrong}
DETAILS = {"file": {"has"}, "code": set(), "launch": {"nodes", "params", "clears"},
           "robot": {"links", "joints", "values"}, "yaml": {"values"}, "typed": set(),
           "tested": {"by"}, "wrong": {"readme"}}


@pytest.mark.parametrize("row", ROWS)
def test_row(row):
    checks = [name for name in CHECKS if name in row]
    known = {"page", *checks}.union(*(DETAILS[name] for name in checks))
    assert checks, "a row without a check"
    assert set(row) <= known, f"unknown: {set(row) - known}"
    for name in checks:
        CHECKS[name](row)


@pytest.mark.parametrize("page", PAGES)
def test_no_row_stands_twice(page):
    names = [row["page"] for row in PAGES[page]]
    assert len(names) == len(set(names))
