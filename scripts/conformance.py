"""Which tests cover which rows of the interface table, and their results.

A comment in a test names what it covers: `# conforms: ROW/TAG, ROW`; `ROW/each` is all its tags.
After a run of the tests `python3 scripts/conformance.py` prints the table with each row's tests and
whether they passed.
"""

from __future__ import annotations

import contextlib
import re
import sys
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path

from bullet_sim_ros.interface import APPROXIMATED, WORKS, Section, read_interface, rows_by_name

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "out" / "test"
FUNCTION = re.compile(r"^\s*def (test_\w+)")
CONFORMS = re.compile(r"^\s*# conforms: (.+?)\s*$")
FAILED, NOT_RUN, PASSED = "FAILED", "not run", "ok"


def covered() -> dict[str, set[str]]:
    """Names of rows and tags, each with the test functions that cover it."""
    found: dict[str, set[str]] = defaultdict(set)
    rows = rows_by_name(read_interface())
    for path in sorted(ROOT.glob("src/**/test/**/*.py")):
        function = ""
        for line in path.read_text(encoding="utf-8").splitlines():
            if begun := FUNCTION.match(line):
                function = begun[1]
            elif says := CONFORMS.match(line):
                for name in map(str.strip, says[1].split(",")):
                    row = name.removesuffix("/each")
                    tags = () if row == name else rows[row].tags
                    for each in [f"{row}/{tag}" for tag in tags] or [name]:
                        found[each].add(function)
    return found


def outcomes(folder: Path = RESULTS) -> dict[str, str]:
    """Each test function of the last run: FAILED if any of its cases did, else ok."""
    found: dict[str, str] = {}
    for path in folder.rglob("*.xml"):
        with contextlib.suppress(ET.ParseError):  # the run was ended while writing it
            for case in ET.parse(path).iter("testcase"):
                function = (case.get("name") or "").split("[")[0]
                bad = case.find("failure") is not None or case.find("error") is not None
                if bad or found.get(function) != FAILED:
                    found[function] = FAILED if bad else PASSED
    return found


def report(sections: list[Section], tests: dict[str, set[str]], results: dict[str, str]) -> str:
    """One line a row: status, tags, tests, verdict."""
    lines = []
    for section in sections:
        lines.append(f"\n{section.title}")
        for row in section.rows:
            functions = {function for name, _ in row.names() for function in tests.get(name, ())}
            states = {results.get(function, NOT_RUN) for function in functions}
            verdict = next((state for state in (FAILED, NOT_RUN, PASSED) if state in states), "-")
            tags = f"{len(row.tags)} inside" if row.tags else ""
            lines.append(f"  {verdict:8s}{row.status:13s}{len(functions):3d} tests  "
                         f"{row.name}{'  ' if tags else ''}{tags}")
    return "\n".join(lines).lstrip("\n")


def uncovered(sections: list[Section], tests: dict[str, set[str]]) -> list[str]:
    """Rows and tags listed as working that no test covers."""
    return [name for section in sections for row in section.rows for name, entry in row.names()
            if entry.status in (WORKS, APPROXIMATED) and not tests.get(name)
            and not (entry is row and row.tags)]


def unknown(sections: list[Section], tests: dict[str, set[str]]) -> list[str]:
    """Names in tests' comments that no row has."""
    names = {name for section in sections for row in section.rows for name, _ in row.names()}
    return sorted(set(tests) - names)


if __name__ == "__main__":
    print(report(read_interface(), covered(), outcomes()))
    sys.exit(0)
