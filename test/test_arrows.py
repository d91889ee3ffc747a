"""Imports follow the arrows of arrows.yaml beside this file."""

import ast
import functools
import graphlib
import re
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
RULES = yaml.safe_load((Path(__file__).parent / "arrows.yaml").read_text(encoding="utf-8"))
ROOMS: list[str] = RULES.pop("rooms")
ROS = re.compile(
    r"ros|ros[a-z]+|\w+_(msgs|srvs)|tf|tf2\w*|cv_bridge|genpy|genmsg|catkin\w*|message_filters"
    r"|actionlib\w*|dynamic_reconfigure|topic_tools|image_geometry|laser_geometry|turtlesim"
)


def our_packages() -> set[str]:
    """Names of catkin packages and of the Python packages in them.

    What is two files for CMake alone has no module: tf2_geometry_msgs is Debian's in Python.
    """
    manifests = [path for path in ROOT.glob("src/**/package.xml")
                 if len(list(path.parent.iterdir())) > 2]
    modules = [init.parent for m in manifests for init in m.parent.glob("src/*/__init__.py")]
    return {m.parent.name for m in manifests} | {folder.name for folder in modules}


OURS = our_packages()


@functools.cache
def python_files() -> list[Path]:
    """Everything written in Python below src/; tests may look anywhere, setup.py is catkin's."""
    found = []
    for path in sorted(p for p in ROOT.glob("src/**/*") if p.is_file()):
        if path.parent.name == "exercises" and (path.parent.parent / "exercises.yaml").exists():
            continue  # a learner's, and perhaps half written
        if path.name == "setup.py" or {"test", "__pycache__"} & set(path.relative_to(ROOT).parts):
            continue
        if path.suffix == ".py" or (path.suffix == "" and first_line(path).endswith("python3")):
            found.append(path)
    return found


def first_line(path: Path) -> str:
    with path.open("rb") as file:
        return file.readline(80).decode("utf-8", "replace").strip()


@functools.cache
def absolute_imports(source: str) -> list[ast.Import | ast.ImportFrom]:
    """Wherever in the file they stand."""
    return [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Import)
            or (isinstance(node, ast.ImportFrom) and node.level == 0)]


def imported(source: str) -> list[tuple[int, str]]:
    """(line, top-level module) of each absolute import."""
    found = []
    for node in absolute_imports(source):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name.split(".")[0]) for alias in node.names]
        else:
            found.append((node.lineno, (node.module or "").split(".")[0]))
    return found


def rule_folder(path: str) -> str | None:
    """The narrowest rule that holds there; a rule may name one file."""
    return max((folder for folder in RULES if f"{path}/".startswith(f"{folder}/")), key=len,
               default=None)


def own_name(path: str) -> str:
    """The catkin package that a file lies in."""
    folder = (ROOT / path).parent
    while folder not in (ROOT, folder.parent):
        if (folder / "package.xml").exists():
            return folder.name
        folder = folder.parent
    return ""


def complaint(folder: str, package: str, module: str) -> str | None:
    """Why this folder may not import this module, or None."""
    rule = RULES[folder]
    if module == package or module in rule["ours"] or module in sys.stdlib_module_names:
        return None
    if module == "pybullet" and folder != "src/sim/bullet_sim":
        return "pybullet belongs to src/sim/bullet_sim alone"
    if module in OURS:
        return f"{folder} may import of ours only {rule['ours']}"
    if ROS.fullmatch(module):
        return None if rule["ros"] else f"{folder} may not import ROS"
    if "only" in rule and module not in rule["only"]:
        return f"{folder} may import besides the standard library only {rule['only']}"
    return None


def broken_arrows(path: str, source: str) -> list[str]:
    folder = rule_folder(path)
    if folder is None:
        return [f"{path}: no rule in test/arrows.yaml has this folder"]
    found = []
    for line, module in imported(source):
        why = complaint(folder, own_name(path), module)
        if why:
            found.append(f"{path}:{line}: imports {module}: {why}")
    return found


def test_imports_follow_the_arrows() -> None:
    broken = []
    for path in python_files():
        broken += broken_arrows(str(path.relative_to(ROOT)), path.read_text(encoding="utf-8"))
    assert not broken, "\n" + "\n".join(broken)


def test_each_arrow_has_a_user() -> None:
    """No rule allows what no file of its folder does."""
    used: dict[str, set[str]] = {}
    for path in python_files():
        folder = rule_folder(str(path.relative_to(ROOT)))
        names = {name for _, name in imported(path.read_text(encoding="utf-8"))}
        used.setdefault(folder or "", set()).update(names)
    assert not unused_arrows(RULES, used)


def unused_arrows(rules: dict[str, dict], used: dict[str, set[str]]) -> list[str]:
    """`used`: modules that the files of each rule's folder import."""
    found = []
    for folder, rule in rules.items():
        names = used.get(folder)
        if names is None:
            found.append(f"{folder}: no Python file falls under this rule")
            continue
        found += [f"{folder}: nobody imports {name}"
                  for name in (*rule["ours"], *rule.get("only", ())) if name not in names]
        if rule["ros"] and not any(ROS.fullmatch(name) for name in names):
            found.append(f"{folder}: nobody imports ROS")
    return found


def test_the_check_for_unused_arrows_itself() -> None:
    rules = {"src/a": {"ours": ["b"], "ros": True, "only": ["numpy"]},
             "src/b": {"ours": [], "ros": False}}
    assert len(unused_arrows(rules, {"src/a": {"os"}})) == 4
    assert not unused_arrows(rules, {"src/a": {"b", "rospy", "numpy"}, "src/b": set()})


def rooms_by_module() -> dict[str, str]:
    """The folder below src/ of each of our modules and message packages."""
    rooms = {}
    for manifest in ROOT.glob("src/**/package.xml"):
        package, room = manifest.parent, manifest.relative_to(ROOT / "src").parts[0]
        rooms.update({init.parent.name: room for init in package.glob("src/*/__init__.py")})
        if any((package / kind).is_dir() for kind in ("msg", "srv", "action")):
            rooms[package.name] = room
    return rooms


def upward_arrows(path: str, source: str, rooms: dict[str, str], order: list[str]) -> list[str]:
    """Imports of a file below src/ from a room that does not come before its own."""
    own = path.split("/")[1]
    return [f"{path}:{line}: src/{own} imports {module} of src/{rooms[module]}, which is not below"
            for line, module in imported(source)
            if rooms.get(module, own) != own and rooms[module] not in order[:order.index(own)]]


def test_no_room_imports_from_one_above_it() -> None:
    assert {path.relative_to(ROOT / "src").parts[0] for path in python_files()} <= set(ROOMS)
    rooms, found = rooms_by_module(), []
    for path in python_files():
        name = str(path.relative_to(ROOT))
        found += upward_arrows(name, path.read_text(encoding="utf-8"), rooms, ROOMS)
    assert not found, "\n" + "\n".join(found)


def test_the_check_for_upward_arrows_itself() -> None:
    rooms = rooms_by_module()
    assert rooms["gazebo_msgs"] == "interfaces" and rooms["move_base"] == "navigation"
    assert "xacro" not in rooms  # what bullet_sim imports is PyPI's
    assert upward_arrows("src/sim/x.py", "import evaluation.lap", rooms, ROOMS)
    assert not upward_arrows("src/evaluation/x.py", "import bullet_sim, cv2", rooms, ROOMS)


def modules() -> dict[str, Path]:
    """Our modules by their dotted names."""
    found = {}
    for manifest in ROOT.glob("src/**/package.xml"):
        folder = manifest.parent / "src"
        for path in folder.rglob("*.py"):
            words = path.relative_to(folder).with_suffix("").parts
            found[".".join(words[:-1] if words[-1] == "__init__" else words)] = path
    return found


def imported_modules(name: str, source: str, known: dict[str, Path]) -> set[str]:
    """Modules of ours that a source imports, also within functions or for type checkers only."""
    found = set()
    for node in absolute_imports(source):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        else:
            inner = [f"{node.module}.{alias.name}" for alias in node.names]
            found |= {node.module, *inner}  # what is imported from a package runs the package
    return (found & known.keys()) - {name}


def circle(graph: dict[str, set[str]]) -> list[str]:
    """Modules of one circle, or none."""
    try:
        list(graphlib.TopologicalSorter(graph).static_order())
    except graphlib.CycleError as error:
        return error.args[1]
    return []


def test_no_modules_import_one_another_in_a_circle() -> None:
    known = modules()
    assert len(known) > 500
    graph = {name: imported_modules(name, path.read_text(encoding="utf-8"), known)
             for name, path in known.items()}
    assert not circle(graph)


def test_the_check_for_circles_itself() -> None:
    known = dict.fromkeys(("a", "a.b", "a.c"), ROOT)
    sources = {
        "a": "", "a.b": "if TYPE_CHECKING:\n  from a import c",
        "a.c": "def f():\n  import a.b"}
    graph = {name: imported_modules(name, source, known) for name, source in sources.items()}
    assert set(circle(graph)) == {"a.b", "a.c"}
    graph = {"a": imported_modules("a", "from a.b import x", known),
             "a.b": imported_modules("a.b", "from a import c", known), "a.c": set()}
    assert set(circle(graph)) == {"a", "a.b"}


@pytest.mark.parametrize(
    ("path", "source", "broken"),
    [
        ("src/sim/bullet_sim/src/bullet_sim/world.py", "import rospy", True),
        ("src/sim/bullet_sim/src/bullet_sim/world.py", "def f():\n  import std_msgs.msg", True),
        ("src/sim/bullet_sim/src/bullet_sim/world.py", "from bullet_sim import pose", False),
        ("src/sim/bullet_sim/src/bullet_sim/world.py", "import bullet_sim_ros", True),
        ("src/learning_topic/scripts/x.py", "import bullet_sim", True),
        ("src/learning_topic/scripts/x.py", "import scipy", True),
        ("src/learning_topic/scripts/x.py", "import cv2, rospy, learning_topic.msg", False),
        ("src/evaluation/scripts/x.py", "import bullet_sim_ros", True),
        ("src/evaluation/scripts/x.py", "import pybullet", True),
        ("src/nowhere/x.py", "import os", True),
    ],
)
def test_the_check_itself(path: str, source: str, broken: bool) -> None:
    assert bool(broken_arrows(path, source)) is broken


def test_what_reads_files_knows_no_engine_and_no_controller() -> None:
    known = modules()
    reached = {other.split(".")[1] for name, path in known.items()
               if name.startswith("bullet_sim.formats.")
               for other in imported_modules(name, path.read_text(encoding="utf-8"), known)
               if other.startswith("bullet_sim.")}
    assert {"description", "errors", "pose"} <= reached
    assert not reached & {"control", "drives", "joint", "link", "mechanisms", "model", "physics",
                          "rendering", "sensors", "world"}
