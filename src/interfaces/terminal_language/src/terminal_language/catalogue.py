"""Looks texts up in a gettext catalogue, also those that have their values in them already."""

from __future__ import annotations

import gettext
import re
from functools import cache
from pathlib import Path

DOMAIN = "courses"
LOCALES = Path(__file__).parent / "locale"
PLACE = re.compile(r"\{(\d+)\}")
# What may stand around a text: line ends, indents, escape codes, "[gzclient] ", and rospy's
# "[WARN] [12.3, 4.5]: ".
AROUND = re.compile(r"((?:\s|\x1b\[[\d;]*[A-Za-z])*(?:\[\w+\] (?:\[[\d., ]+\]: )?)?)(.*?)"
                    r"((?:\s|\x1b\[[\d;]*[A-Za-z])*)", re.DOTALL)
PROGRAM = re.compile(r"(?:gz )?[A-Za-z_]\w*")  # before its text
FAULT = "{0}: error: {1}"  # argparse's, of a program's arguments
JOINTS = re.compile(r"(: |; )")
# Such as argparse's default.
IN_BRACKETS = re.compile(r"(.+)( \((?:[^()]|\([^()]*\))*\))", re.DOTALL)
MOST_PARTS = 8  # of a text between colons and semicolons; more are a list, an item at a time
WORD = re.compile(r"[A-Za-z]{2,}")
XML = re.compile(r"\s*<(?!\w+>:\d)")  # not <stdin>:1, a place
# Where a value begins or ends: no space between Chinese characters, one between a Chinese
# character and a Latin letter or digit.
SPACED = re.compile(r"(?<=[\u4e00-\u9fff])(?: \0|\0 )(?=[\u4e00-\u9fff])")
UNSPACED = re.compile(r"(?<=[\u4e00-\u9fff])\0+(?=[A-Za-z0-9])"
                      r"|(?<=[A-Za-z0-9])\0+(?=[\u4e00-\u9fff])")
NAMES = re.compile(r"[\w./-]+(, [\w./-]+){2,}")  # a list of them stays as it is
QUOTED = re.compile(r"'[()]'")  # a bracket that is spoken of
FEWEST_WORDS = 3  # of what stays English; what has fewer is a frame for other texts
VALUE = "value\4"  # gettext's msgctxt
LONGEST = 3000  # characters of a line
DEPTH = 4  # of texts within texts


class Sentence:
    """An English text with {0}, {1} ... in place of its values, and its translation."""

    def __init__(self, english: str, translation: str) -> None:
        self._parts = PLACE.split(english)
        self.translation = translation
        self._leads = PLACE.match(translation) is not None
        self._is_list = "; " in "".join(self._parts[::2])
        self.longest = max(self._parts[::2], key=len)
        self.weight = sum(map(len, self._parts[::2]))

    def values(self, text: str) -> dict[int, str] | None:
        """The values by number that make this sentence the text, or None; each the shortest.

        No value has half of a pair of brackets. A sentence that begins with words and has no
        semicolon ends before one; a value that it begins with has no joint, or stays in front.
        Takes linear time, which a regular expression of many places does not.
        """
        first, *further, last = self._parts[::2]
        at, end = len(first), len(text) - len(last)
        if self.longest not in text or at > end or not (
                text.startswith(first) and text.endswith(last)):
            return None
        values = []
        for number, part in enumerate(further, start=1):
            find = text.rfind if last and number == len(further) else text.find
            found = find(part, at, end)
            if found < 0:
                return None
            values.append(text[at:found])
            at = found + len(part)
        values.append(text[at:end])
        bare = [QUOTED.sub("", value) for value in values]
        if any(value.count("(") != value.count(")") for value in bare):
            return None
        if not first and not self._leads and JOINTS.search(values[0]):
            return None
        ends = values if last else values[:-1]
        if first and not self._is_list and any("; " in value for value in ends):
            return None
        return dict(zip(map(int, self._parts[1::2]), values, strict=True))

    def filled(self, values: dict[int, str]) -> str:
        """The translation with these values, Latin ones with spaces beside Chinese."""
        marked = PLACE.sub(lambda place: f"\0{values[int(place[1])]}\0", self.translation)
        return UNSPACED.sub(" ", SPACED.sub("", marked)).replace("\0", "")


class Catalogue:
    """The translations of one language; texts that it does not know stay as they are."""

    def __init__(self, messages: dict[str, str]) -> None:
        self._exact = {english: text for english, text in messages.items() if english and text}
        for english, text in tuple(self._exact.items()):  # also the part behind a joint
            if english.startswith("; "):
                self._exact.setdefault(english[2:], text.lstrip("；; "))
        sentences = (Sentence(*both) for both in self._exact.items() if PLACE.search(both[0]))
        self._sentences = sorted(sentences, key=lambda sentence: -sentence.weight)

    def translate(self, text: str) -> str:
        """The text in the catalogue's language, line by line; XML and long lines as they are."""
        return "".join(map(self._line, text.splitlines(keepends=True)))

    def _line(self, line: str) -> str:
        if len(line) > LONGEST or XML.match(line):
            return line
        found = self._around(line)
        return line if found is None else found

    def _around(self, text: str, depth: int = DEPTH) -> str | None:
        before, inner, after = AROUND.fullmatch(text).groups()
        found = self._message(inner, depth) if inner and not NAMES.fullmatch(inner) else None
        if found is None:
            return None
        # A full-width bracket has its space within.
        return (before.rstrip(" ") if found.startswith("（") else before) + found + after

    def _message(self, text: str, depth: int) -> str | None:
        """The translation of the text, or of its parts between colons and semicolons."""
        if text in self._exact:
            return self._exact[text]
        name, _, fault = text.partition(": error: ")
        if fault.startswith("argument ") and FAULT in self._exact:
            return Sentence(FAULT, self._exact[FAULT]).filled(
                {0: name, 1: self._message(fault, depth) or fault})
        name, _, rest = text.partition(": ")
        program = name != "usage" and PROGRAM.fullmatch(name)
        if program and rest in self._exact:
            return f"{self._exact.get(name, name)}: {self._exact[rest]}"
        if (program and 0 < self._weight(rest) >= self._weight(text)
                and (told := self._clause(rest, depth)) is not None):
            return f"{self._exact.get(name, name)}: {told}"
        found = self._clause(text, depth)
        parts = JOINTS.split(text)
        if found is not None or len(parts) == 1:
            return found
        if len(parts) > 2 * MOST_PARTS:
            return self._long_list(text.split("; "), depth)
        told, at, any_found = "", 0, False
        while at < len(parts):
            for end in range(len(parts), at, -2):
                found = self._clause("".join(parts[at:end]), depth)
                if found is not None:
                    break
            any_found = any_found or found is not None
            told += parts[at] if found is None else found
            told += parts[end] if end < len(parts) else ""
            at = end + 1
        return told if any_found else None

    def _long_list(self, items: list[str], depth: int) -> str | None:
        """The translation of each item for itself."""
        if len(items) == 1:
            return None
        found = [self._message(item, depth) for item in items]
        return "; ".join(new or old for new, old in zip(found, items, strict=True)) if any(
            found) else None

    def _clause(self, text: str, depth: int) -> str | None:
        """The translation of a text, or of what stands before its brackets, and of those."""
        found = self._sentence(text, depth)
        if found is None and (ending := IN_BRACKETS.fullmatch(text)):
            head, inside = self._sentence(ending[1], depth), ending[2].strip()
            if head is not None:
                found = head + (self._around(ending[2], depth - 1) or ending[2])
            elif not JOINTS.search(ending[1]):  # a name, and why or what is meant
                why, meant = self._exact.get(inside[1:-1]), self._sentence(inside, depth - 1)
                found = f"{ending[1]}（{why}）" if why else meant and ending[1] + meant
        return found

    def _weight(self, text: str) -> int:
        """The number of letters of the sentence that a text is an instance of, or 0."""
        return next((sentence.weight for sentence in self._sentences
                     if sentence.values(text) is not None), 0)

    def _sentence(self, text: str, depth: int) -> str | None:
        if text in self._exact or depth == 0:
            return self._exact.get(text)
        for sentence in self._sentences:
            values = sentence.values(text)
            if values is not None:
                return sentence.filled({
                    number: self._around(value, depth - 1) or self._exact.get(VALUE + value, value)
                    for number, value in values.items()})
        return None


@cache
def read_catalogue(language: str) -> Catalogue:
    """The catalogue of a language of LOCALES, such as zh_CN, and sentences that stay English.

    Raises: OSError: there is none.
    """
    translations = gettext.translation(DOMAIN, LOCALES, [language])
    kept = (LOCALES / "kept.txt").read_text(encoding="utf-8").splitlines()
    return Catalogue(
        {line: line for line in kept if len(WORD.findall(PLACE.sub("", line))) >= FEWEST_WORDS}
        | {key: text for key, text in translations._catalog.items() if isinstance(key, str)})
