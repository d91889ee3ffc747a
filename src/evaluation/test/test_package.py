"""The package as a whole: its manifest names what it uses; its trials leave each other alone."""

import ast
import re
from pathlib import Path
from xml.etree import ElementTree

import rospkg

PACKAGE = Path(__file__).resolve().parent.parent
SOURCE = PACKAGE / "src" / "evaluation"
SHARED = {"session", "trial", "laps", "house", "mapping"}  # what trials stand on
TRIALS = {"autorace", "course_run", "race_trials", "lane", "tracking", "navigation", "localisation",
          "yards"}


def imports(path: Path) -> set[str]:
    """Modules that a file imports, by their full names."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import)
             for alias in node.names}
    return found | {node.module for node in ast.walk(tree)
                    if isinstance(node, ast.ImportFrom) and node.module}


def test_every_folder_is_a_trial_or_shared():
    assert {each.parent.name for each in SOURCE.glob("*/__init__.py")} == SHARED | TRIALS


def test_no_trial_imports_another_and_nothing_shared_imports_a_trial():
    broken = []
    for path in SOURCE.rglob("*.py"):
        own = path.relative_to(SOURCE).parts[0]
        for module in imports(path):
            package, _, rest = module.partition(".")
            other = rest.partition(".")[0]
            if package == "evaluation" and other in TRIALS and other != own:
                broken.append(f"{path}: {module}")
    assert not broken


def test_the_manifest_names_every_package_that_is_used():
    manifest = ElementTree.parse(PACKAGE / "package.xml")
    declared = {each.text for each in manifest.iter("exec_depend")}
    known = set(rospkg.RosPack().list())
    used = {module.partition(".")[0] for path in PACKAGE.rglob("*.py") if "test" not in path.parts
            for module in imports(path)}
    for path in (*PACKAGE.glob("launch/*.launch"), *PACKAGE.glob("courses/*.yaml")):
        text = path.read_text(encoding="utf-8")
        for pattern in (r"\$\(find (\w+)\)", r'pkg="(\w+)"', r"launch: \[(\w+),"):
            used |= set(re.findall(pattern, text))
    assert not (used & known) - declared - {"evaluation"}
