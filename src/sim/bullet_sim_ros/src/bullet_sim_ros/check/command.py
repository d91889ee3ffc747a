"""The command-line interface of check."""

import argparse
import pickle
import re
import sys
import tempfile
from pathlib import Path

import rospkg
from workspace_needs.hidden import unsourced
from workspace_needs.verdicts import Verdict, judge
from workspace_needs.workspace import WorkspaceError, source_folder

from bullet_sim.errors import did_you_mean
from bullet_sim.formats.xacro.bounds import TooLarge, run_bounded
from bullet_sim_ros.check.findings import (
    ABSENT,
    ACCEPTED,
    PROBLEM,
    UNCHECKED,
    WORKS,
    Finding,
    is_serious,
    problem,
    table,
)
from bullet_sim_ros.check.launches import LaunchChecker
from bullet_sim_ros.check.sources import program_findings
from bullet_sim_ros.check.texts import TextChecker
from bullet_sim_ros.interface import read_interface, rows_by_name
from bullet_sim_ros.package_paths import open_resources

EPILOG = """examples:
  rosrun bullet_sim_ros check robot.urdf.xacro model:=big    a robot
  rosrun bullet_sim_ros check my_world.world                 a world
  rosrun bullet_sim_ros check learning_topic                 all robots, worlds, launch files of it
  rosrun bullet_sim_ros check learning_topic 0course.launch  what this launch file starts
  rosrun bullet_sim_ros check ~/catkin_ws                    which packages of a workspace build
exit code: 0 if all of it will work, if need be approximated; 1 if something will be missing"""
LONGEST = 60.0  # s of processor time for a file; large worlds take 10
MOST_BYTES = 2**31
INCLUDED = re.compile(r"<(?:xacro:)?include\b[^>]*filename=[\"']([^\"']+)[\"']")


def main(argv: list[str] | None = None) -> int:
    """Print the table; 0, 1 if something will be missing, 2 if there is no such file or package."""
    parser = argparse.ArgumentParser(
        prog="check",
        description="Says what of a robot, world, package or workspace will work here.",
        epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", help="file (.urdf .xacro .sdf .world .launch), model folder, "
                                     "package or workspace")
    parser.add_argument("launch", nargs="?", help="launch file of the package")
    parser.add_argument("arguments", nargs="*", metavar="name:=value", help="for xacro or launch")
    parser.add_argument("--all", action="store_true", help="also list accepted tags without effect")
    parser.add_argument("--run-commands", action="store_true",
                        help="run the commands of a launch file's parameters; without it xacro "
                             "and cat are done here, and others are named")
    args = parser.parse_args(argv)
    if args.launch and ":=" in args.launch:
        args.arguments.insert(0, args.launch)
        args.launch = None
    try:
        findings = Check(args.arguments, args.run_commands).run(args.what, args.launch)
    except WorkspaceError as error:
        print(f"check: {error}", file=sys.stderr)
        return 2
    if not findings:
        near = (unsourced(args.what)
                or did_you_mean(args.what, rospkg.RosPack().list(), 0.75))
        what = (f"no such file or package{near}; try `rospack list`, or give a path"
                if findings is None else
                "there is nothing to check: no robot, world or launch file, and no workspace "
                "with packages of your own")
        print(f"check: {args.what}: {what}", file=sys.stderr)
        return 2 if findings is None else 0
    shown = findings if args.all else [f for f in findings if f.status != ACCEPTED]
    print(table(shown))
    left_out = len(set(findings)) - len(set(shown))
    if left_out:
        print(f"\n{left_out} ignored tags and elements are not listed: --all")
    serious = is_serious(findings)
    all_of_it = ("all that was checked" if any(found.status == UNCHECKED for found in findings)
                 else "all of it")
    print("\nsomething will be missing, see above" if serious else f"\n{all_of_it} will work")
    return 1 if serious else 0


class Check:
    """Checks the contents of a file, package or workspace."""

    def __init__(self, arguments: list[str], run_commands: bool):
        self._arguments = arguments
        resources = open_resources()
        rows = rows_by_name(read_interface())
        self._texts = TextChecker(rows, resources)
        self._launches = LaunchChecker(rows, self._texts, resources, run_commands)

    def run(self, what: str, launch: str | None) -> list[Finding] | None:
        """The findings; None if `what` does not exist; WorkspaceError if it has no packages."""
        path = Path(what).expanduser()
        if path.is_file():
            return self._file(path.resolve())
        if path.is_dir() and (path / "model.sdf").is_file():
            return self._file((path / "model.sdf").resolve())
        try:
            folder = Path(rospkg.RosPack().get_path(what))
        except rospkg.ResourceNotFound:
            if not (what and path.is_dir()):
                return None
            folder = path.resolve()
            if not (folder / "package.xml").is_file():
                return workspace_findings(folder)
        return self._one_launch(folder, launch) if launch else self._package(folder)

    def _file(self, path: Path, alone: bool = True) -> list[Finding]:
        """As `_looked_at`, in a process of its own with limits of time and memory."""
        with tempfile.TemporaryDirectory(prefix="check-") as folder:
            result = Path(folder) / "findings"

            def look() -> int:
                tempfile.tempdir = folder  # so that what an ended process leaves goes, too
                result.write_bytes(pickle.dumps(self._looked_at(path, alone)))
                return 0

            try:
                if run_bounded(look, str(path), LONGEST, "checking it", MOST_BYTES) == 0:
                    return pickle.loads(result.read_bytes())  # our own, from the line above
            except TooLarge as error:
                return [problem(str(path), "file", error)]
        return [problem(str(path), "file", "checking it failed, see above")]

    def _looked_at(self, path: Path, alone: bool) -> list[Finding]:
        """`alone`: the user named this file, and not only its package."""
        if path.suffix == ".yaml":
            return self._launches.yaml_file(path)
        if path.suffix == ".launch":
            return self._launches.launch_file(path, self._arguments, alone)
        if path.suffix == ".world":
            return self._texts.world_file(path)
        values = dict(word.split(":=", 1) for word in self._arguments if ":=" in word)
        if path.suffix == ".sdf" and "<world" in path.read_text("utf-8", "replace"):
            return self._texts.world_file(path)
        return self._texts.model_file(path, values, shown_only=not alone)

    def _one_launch(self, folder: Path, name: str) -> list[Finding]:
        kind = Path(name).suffix or ".launch"
        there = sorted(folder.rglob(f"*{kind}"))
        found = [path for path in there if str(path).endswith(f"/{name}")]
        if not found:
            names = sorted(path.name for path in folder.rglob("*.launch"))
            return [problem(str(folder), f"launch file {name}",
                            f"not there{did_you_mean(name, names, 0.75)}; there are: "
                            f"{', '.join(names) or 'none'}")]
        return self._file(found[0])

    def _package(self, folder: Path) -> list[Finding]:
        findings = list(program_findings(folder))
        for pattern in ("*.urdf", "*.xacro", "*.world", "model.sdf", "*.launch"):
            for path in sorted(folder.rglob(pattern)):
                if path.suffix != ".xacro" or _is_robot(path, folder):
                    findings += self._file(path, alone=False)
        for path in sorted(folder.rglob("*.yaml")):
            findings += self._file(path, alone=False)
        return findings


def _is_robot(path: Path, folder: Path) -> bool:
    """Whether a xacro file is a robot by itself, and not a part that others include."""
    included = {Path(name).name for other in folder.rglob("*.xacro")
                for name in INCLUDED.findall(other.read_text("utf-8", "replace"))}
    return path.name not in included and "<link" in path.read_text("utf-8", "replace")


def workspace_findings(path: Path) -> list[Finding]:
    """A few findings per package; WorkspaceError if there is none below `path`."""
    source = source_folder(path)
    try:
        verdicts = judge(source)
    except WorkspaceError as error:
        return [Finding(f"workspace {path}", "build", PROBLEM, str(error))]
    found = [finding for verdict in verdicts
             for finding in (*_of_package(verdict, path), *program_findings(verdict.folder))]
    return [*found, Finding(f"workspace {path}", "what is in the packages", UNCHECKED,
                            "robots, worlds, launch files and YAML are looked at one package at a "
                            "time: rosrun bullet_sim_ros check PACKAGE")]


def _of_package(verdict: Verdict, workspace: Path) -> list[Finding]:
    where = f"package {verdict.name} ({verdict.folder})"
    found = [Finding(where, "build", PROBLEM, f"it is left out: {key}: {why}")
             for key, why in verdict.stops.items()]
    found += [Finding(where, "catkin_make", PROBLEM, f"it is left out: {key}: {why}")
              for key, why in verdict.clashes.items()]
    found += [Finding(where, file, ABSENT, f"left out: {why}")
              for file, why in verdict.left_out.items()]
    found += [Finding(where, name, ABSENT, f"{key} needs it: make deps WS={workspace}")
              for name, key in verdict.missing.items()]
    found += [Finding(where, key, ABSENT, f"it will be without: {why}")
              for key, why in verdict.lacks.items()]
    if not verdict.stops and not verdict.missing:
        found.append(Finding(where, "build", WORKS))
    return found
