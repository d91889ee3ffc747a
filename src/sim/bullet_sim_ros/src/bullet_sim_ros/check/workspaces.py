"""A workspace before it is built: which packages build, what they need, what is left out."""

from __future__ import annotations

from pathlib import Path

from workspace_needs.verdicts import Verdict, judge
from workspace_needs.workspace import WorkspaceError, source_folder

from bullet_sim_ros.check.findings import ABSENT, APPROXIMATED, PROBLEM, WORKS, Finding


def is_workspace(path: Path) -> bool:
    """Whether it is the folder above a src/ with packages, and no package itself."""
    if not (path / "src").is_dir() or (path / "package.xml").exists():
        return False
    try:
        return source_folder(path) == (path / "src").resolve()
    except WorkspaceError:
        return False


def workspace_findings(path: Path) -> list[Finding]:
    """A few lines a package."""
    return [finding for verdict in judge(source_folder(path))
            for finding in _of_package(verdict, path)]


def _of_package(verdict: Verdict, workspace: Path) -> list[Finding]:
    where = f"package {verdict.name} ({verdict.folder})"
    found = [Finding(where, "build", PROBLEM, f"it is left out: {key}: {why}")
             for key, why in verdict.stops.items()]
    found += [Finding(where, file, ABSENT, f"left out: {why}")
              for file, why in verdict.left_out.items()]
    found += [Finding(where, name, ABSENT, f"{key} needs it: make deps WS={workspace}")
              for name, key in verdict.missing.items()]
    found += [Finding(where, key, APPROXIMATED, f"it does without: {why}")
              for key, why in verdict.lacks.items()]
    if not verdict.stops and not verdict.missing:
        found.append(Finding(where, "build", WORKS))
    return found
