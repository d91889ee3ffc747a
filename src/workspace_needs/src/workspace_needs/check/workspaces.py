"""Checks a workspace: whether its packages build, and what is in them."""

import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import rospkg

from workspace_needs.check.contents import Check, files_of
from workspace_needs.check.findings import ABSENT, PROBLEM, SERIOUS, UNCHECKED, WORKS, Finding
from workspace_needs.check.modules import source_of
from workspace_needs.check.sources import package_of, program_findings
from workspace_needs.verdicts import Verdict, judge
from workspace_needs.workspace import WorkspaceError, source_folder

LONGEST = 120.0  # s, wall, after which no further file is looked at


def workspace_findings(path: Path, arguments: list[str], run_commands: bool) -> list[Finding]:
    """Findings about each package below `path`, built or not; WorkspaceError if there is none.

    Of what is in a package only that is listed which does not simply work.
    """
    source = source_folder(path)
    try:
        verdicts = judge(source)
    except WorkspaceError as error:
        return [Finding(f"workspace {path}", "build", PROBLEM, str(error))]
    files = {verdict.name: [] if verdict.hides_ours else files_of(verdict.folder)
             for verdict in verdicts}
    number = sum(map(len, files.values()))
    if number:
        print(f"launch files, worlds, robots and YAML to look at: {number}; this takes at most "
              f"{LONGEST / 60:g} minutes or so", file=sys.stderr, flush=True)
    check = _open(verdicts, arguments, run_commands)
    until = time.monotonic() + LONGEST
    return [finding for verdict in verdicts
            for finding in (*_of_package(verdict, path),
                            *program_findings(verdict.folder, until, _where(verdict), source),
                            *_of_files(verdict, files[verdict.name], check, until))]


def package_findings(folder: Path, arguments: list[str], run_commands: bool) -> list[Finding]:
    """Findings about a package, built or not: as of its workspace, and about all that is in it."""
    # In share/ it is installed, and so built.
    verdicts, found = ([], []) if folder.parent.name == "share" else _judged(folder)
    check = _open(verdicts, arguments, run_commands)
    own = next((each for each in verdicts if each.folder.resolve() == folder.resolve()), None)
    if own:
        found = _of_package(own, source_of(folder)[0].parent)
    return [*found, *check.package(folder, _where(own) if own else "")]


def file_findings(folder: Path, file: Path | str, arguments: list[str], run_commands: bool
                  ) -> list[Finding]:
    """Findings about a file in `folder`, or about the launch file of that name below it.

    If that is of a package that is not found here, as if its workspace were built and sourced.
    """
    package, verdicts, found = package_of(folder / "package.xml"), [], []
    if Path(file).suffix != ".py" and (package / "package.xml").is_file() and (
            package.resolve() not in _packages_here()):
        verdicts, found = _judged(package)
    check = _open(verdicts, arguments, run_commands)
    return [*found, *(check.file(file) if isinstance(file, Path) else
                      check.launch_of_package(folder, file))]


def _packages_here() -> set[Path]:
    packages = rospkg.RosPack()
    return {Path(packages.get_path(name)).resolve() for name in packages.list()}


def _judged(folder: Path) -> tuple[list[Verdict], list[Finding]]:
    """The verdicts on all packages of the workspace that one is in, or why there are none."""
    source = source_of(folder)[0]
    try:
        return judge(source), []
    except WorkspaceError as error:
        return [], [Finding(f"workspace {source.parent}", "build", PROBLEM, str(error))]


def _open(verdicts: list[Verdict], arguments: list[str], run_commands: bool) -> Check:
    """A checker that finds the workspace's packages as if it were built and sourced."""
    found = [verdict for verdict in verdicts if not verdict.hides_ours]
    places = [*(str(verdict.folder) for verdict in found),
              *filter(None, [os.environ.get("ROS_PACKAGE_PATH")])]
    return Check(arguments, run_commands, {**os.environ, "ROS_PACKAGE_PATH": ":".join(places)},
                 {verdict.name: verdict.programs for verdict in found})


def _of_files(verdict: Verdict, files: list[Path], check: Check, until: float
              ) -> Iterator[Finding]:
    """What does not simply work in a package's files; `until` is a time of time.monotonic()."""
    where = _where(verdict)
    met: list[Finding] = []
    for number, path in enumerate(files):
        if time.monotonic() > until:
            yield Finding(where, f"{len(files) - number} of its {len(files)} files", UNCHECKED,
                          f"the {LONGEST:g} s for the workspace are over; build and source it, "
                          f"then type rosrun bullet_sim_ros check {verdict.name}")
            break
        met += check.file(path, alone=False)
    else:
        if files and not any(found.status in (*SERIOUS, UNCHECKED) for found in met):
            yield Finding(where, f"launch files, worlds, robots and YAML ({len(files)})", WORKS)
    yield from (finding for finding in met if finding.status != WORKS)


def _where(verdict: Verdict) -> str:
    return f"package {verdict.name} ({verdict.folder})"


def _of_package(verdict: Verdict, workspace: Path) -> list[Finding]:
    where = _where(verdict)
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
    found += [Finding(where, "build", PROBLEM, f"{file} will not compile: {why}")
              for file, why in verdict.uncompiled.items()]
    if not (verdict.stops or verdict.missing or verdict.uncompiled):
        found.append(Finding(where, "build", WORKS))
    return found
