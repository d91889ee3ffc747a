"""The package as a whole: its manifest names what it uses; its trials leave each other alone."""

import ast
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import rospkg

PACKAGE = Path(__file__).resolve().parent.parent
SOURCE = PACKAGE / "src" / "evaluation"
SHARED = {"case_process", "command_line", "film", "house", "lap", "lap_trial", "live",
          "picture", "report", "start", "trajectory_error", "trial",
          "run_log", "run_page", "workers"}  # what trials stand on
TRIALS = [{"course_run"}, {"replay", "launch_without"}, {"race_trials"}, {"avoid"},
          {"lane_trials", "lane_encounters"},
          {"track", "track_score", "track_trials"}, {"autorace", "autorace_judge"},
          {"navigate", "navigate_parts", "navigate_pictures", "navigate_score"},
          {"localisation_trials", "localisation_drive"},
          {"navigation_trials", "yard_drive"}]  # the modules of each


def imports(path: Path) -> set[str]:
    """Modules that a file imports, by their full names."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import)
             for alias in node.names}
    sources = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module]
    return found | {node.module for node in sources} | {
        f"{node.module}.{alias.name}" for node in sources for alias in node.names}


def test_every_module_is_shared_or_a_trials():
    there = {path.stem for path in SOURCE.glob("*.py")} - {"__init__"}
    assert there == SHARED.union(*TRIALS)


def test_no_trial_imports_another_and_nothing_shared_imports_a_trial():
    broken = []
    for path in SOURCE.glob("*.py"):
        own = next((modules for modules in TRIALS if path.stem in modules), set())
        for module in imports(path):
            package, _, other = module.partition(".")
            if package == "evaluation" and other in set().union(*TRIALS) - own:
                broken.append(f"{path}: {module}")
    assert not broken


def test_who_scores_a_drive_loads_no_web_server():
    """Its start would take a third longer."""
    code = "import sys, evaluation.course_run; print({'aiohttp', 'asyncio'} & {*sys.modules})"
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "set()\n"


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
