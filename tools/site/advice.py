"""The page "it says X, type Y": every line of ours that names what to do, and ROS's commonest."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

from staging import ROOT, SAYS, Pages, in_sections, table

sys.path.append(str(ROOT / "scripts"))
from terminal_texts import LOCALES, sentence, unquoted

CUT = re.compile(
    r"(?:; |\. |(?<!\btype)(?<!\bas): )(?="
    r"(?:(?:if|for|once|without)\b[^.;:,]*, |in (?:an?|each|another|the)\b[^.;:,]* |then |else )?"
    r"(?:add|allow|answer|ask|build|call|choose|close|connect|correct|delete|end|export|give|"
    r"go|install|leave|let|load|look|make|mend|move|name|open|press|put|remove|rename|run|"
    r"see|send|set|source|spawn|start|stop|take|try|type(?! and| \S+ is)|unset|use|wait|write)\b"
    r"(?:(?<=type):|(?<=see):|,)?\s\S)", re.IGNORECASE)
SIGNS = re.compile(r"(?<!\S)\W+(?!\S)")  # a word of no letters, such as a bracket that is meant
VALUE = re.compile(r"\{\d+\}|\$\{[^{}]*\}|\$\((?!find|rospack|arg|eval)[^()]*\)|\$\w+|%[sd]")
WORD = re.compile(r"[A-Za-z]+")
ENTRY = re.compile(r'^((?:#: .*\n)+)(?:msgctxt .*\n)?msgid ((?:".*"\n)+)msgstr ((?:".*"\n)+)',
                   re.MULTILINE)


def cut(english: str) -> tuple[str, str] | None:
    """What a line says, and what to do then; None if it is no advice.

    It is cut where a sentence or its half ends, outside of quotes and brackets.
    """
    for match in CUT.finditer(english):
        says, do = english[:match.start()], english[match.end():]
        words = SIGNS.sub("", says)
        whole = words.count('"') % 2 == 0 and all(
            words.count(opening) == words.count(closing) for opening, closing in ("()", "[]", "{}"))
        if whole:
            said = len(WORD.findall(VALUE.sub("", says))) > 1
            return (says, do) if said and len(do.split()) > 1 else None
    return None


def helps(path: Path) -> set[str]:
    """The lines of a Python program that only --help shows; none of another file."""
    text = path.read_text("utf-8")
    if path.suffix != ".py" and not text.startswith("#!/usr/bin/env python3"):
        return set()
    return {line.strip() for node in ast.walk(ast.parse(text))
            if isinstance(node, ast.keyword) and node.arg in ("help", "description", "epilog")
            for string in ast.walk(node.value) if isinstance(string, ast.JoinedStr | ast.Constant)
            if not isinstance(string, ast.Constant) or isinstance(string.value, str)
            for line in sentence(string).split("\n")}


def advice() -> dict[str, tuple[str, str, str]]:
    """By "file: line": what an English line says, its advice, and the Chinese line."""
    found = {}
    for name in ("courses", "courses-shell"):
        for places, *texts in ENTRY.findall((LOCALES / f"{name}.po").read_text("utf-8")):
            english, chinese = ("".join(map(unquoted, re.findall(r'^"(.*)"$', text, re.MULTILINE)))
                                for text in texts)
            place = places.split()[1]
            if "/" in place and (parts := cut(english)) and english not in helps(ROOT / place):
                found[f"{place}: {english}"] = (*parts, chinese)
    return found


def add_advice(pages: Pages) -> None:
    """Add the page."""
    ours = advice()
    for language, texts in pages.texts.items():
        lines = [SAYS[language]["advice"]]
        for section, names in in_sections("advice.yaml", ours):
            common = [(_line(each["says"]), each[language]) for each in section.get("common", ())]
            own = [(_line(says), _line(do if language == "en" else chinese))
                   for says, do, chinese in dict.fromkeys(ours[name] for name in names)]
            lines += [f"## {section[language]}", "",
                      *table(language, "system says, do then", common),
                      *table(language, "says, do", own)]
        texts["reference/advice.md"] = "\n".join(lines)


def _line(text: str) -> str:
    """As code in a table's cell, with … for a value."""
    text = re.sub(r'\\(["$\\])', r"\1", VALUE.sub("…", text))  # as a shell prints it
    text = " ".join(text.split())
    return f"`` {text} ``" if "`" in text else f"`{text}`" if text else ""
