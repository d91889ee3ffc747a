"""The findings of a check, and the table made of them."""

import os
from collections.abc import Iterable
from dataclasses import dataclass

from terminal_language import heading, translated
from terminal_language.cells import width
from terminal_language.wanted import wanted_language

from bullet_sim.errors import shortened
from bullet_sim_ros.interface import ABSENT, ACCEPTED, APPROXIMATED, WORKS, Entry

PROBLEM = "problem"
UNCHECKED = "unchecked"
HINT = "hint"
ORDER = (PROBLEM, ABSENT, UNCHECKED, APPROXIMATED, HINT, ACCEPTED, WORKS)
WORDS = {PROBLEM: "PROBLEM", ABSENT: "NOT THERE", UNCHECKED: "not checked",
         APPROXIMATED: "approximated", HINT: "hint", ACCEPTED: "ignored", WORKS: "works"}
SERIOUS = (PROBLEM, ABSENT)  # these make the exit code 1


@dataclass(frozen=True)
class Finding:
    """The result of checking one part."""

    where: str  # file, and robot or world in it
    part: str  # plugin, element, node …
    status: str  # one of ORDER
    how: str = ""


def table(findings: Iterable[Finding]) -> str:
    """Lines, within each file worst first, then those of its lines; each finding counts once."""
    lines, last = [], None
    unique = dict.fromkeys(findings)
    places = list(dict.fromkeys(finding.where for finding in unique))
    for finding in sorted(unique, key=lambda found: (
            places.index(found.where), _line(found.part), ORDER.index(found.status))):
        if finding.where != last:
            lines.append("\n" + shortened(finding.where))
            last = finding.where
        # Each for itself: "build: it" would be taken for what is left out.
        part = heading(finding.part) if finding.part.isalpha() else translated(finding.part)
        said = ": ".join(filter(None, (part, translated(finding.how))))
        word = translated(WORDS[finding.status])
        lines.append(shortened(f"  {word}{' ' * (13 - width(word))} {said}"))
    return "\n".join(lines).lstrip("\n")


def _line(part: str) -> int:
    """The number in `line N`; 0 for other parts."""
    word, _, number = part.partition(" ")
    return int(number) if word == "line" and number.isdecimal() else 0


def problem(where: str, part: str, error: object) -> Finding:
    """A finding that something prevents a part from working."""
    return Finding(where, part, PROBLEM, " ".join(str(error).split()))


def told(entry: Entry) -> str:
    """How a part is supported, in the terminal's language."""
    return entry.how_zh if wanted_language(dict(os.environ)) else entry.how


def is_serious(findings: Iterable[Finding]) -> bool:
    """Whether anything will be missing."""
    return any(finding.status in SERIOUS for finding in findings)
