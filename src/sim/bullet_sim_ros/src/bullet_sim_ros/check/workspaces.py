"""A workspace before it is built: which packages build, what they need, what is left out."""

from pathlib import Path

from workspace_needs.verdicts import Verdict, judge
from workspace_needs.workspace import WorkspaceError, source_folder

from bullet_sim_ros.check.findings import ABSENT, PROBLEM, UNCHECKED, WORKS, Finding


def workspace_findings(path: Path) -> list[Finding]:
    """A few lines a package; WorkspaceError where there is none below `path`."""
    source = source_folder(path)
    try:
        verdicts = judge(source)
    except WorkspaceError as error:
        return [Finding(f"workspace {path}", "build", PROBLEM, str(error))]
    return [finding for verdict in verdicts for finding in _of_package(verdict, path)]


def _of_package(verdict: Verdict, workspace: Path) -> list[Finding]:
    where = f"package {verdict.name} ({verdict.folder})"
    found = [Finding(where, "build", PROBLEM, f"it is left out: {key}: {why}")
             for key, why in verdict.stops.items()]
    found += [Finding(where, file, ABSENT, f"left out: {why}")
              for file, why in verdict.left_out.items()]
    found += [Finding(where, name, ABSENT, f"{key} needs it: make deps WS={workspace}")
              for name, key in verdict.missing.items()]
    found += [Finding(where, key, ABSENT, f"it will be without: {why}")
              for key, why in verdict.lacks.items()]
    found += [Finding(where, name, UNCHECKED, "no list here has it; the build stops there if "
                      "CMake does not find it either")
              for name in verdict.unsure]
    if not verdict.stops and not verdict.missing:
        found.append(Finding(where, "build", WORKS))
    return found
