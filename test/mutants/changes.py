"""The possible small changes of a source file: cosmic-ray's operators, and where they apply."""

from __future__ import annotations

import ast
import difflib
import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cached_property, lru_cache
from itertools import islice
from pathlib import Path
from random import Random

import parso
import yaml
from cosmic_ray.ast import ast_nodes
from cosmic_ray.operators.operator import Operator
from cosmic_ray.operators.provider import OperatorProvider

ROOT = Path(__file__).resolve().parents[2]
SIMULATOR = ROOT / "src/sim/bullet_sim/src/bullet_sim"
NAVIGATION = ROOT / "src/navigation/nav_algorithms/src/nav_algorithms"
PACKAGES = {**{name: SIMULATOR / name for name in ("physics", "formats", "sensors", "control")},
            NAVIGATION.name: NAVIGATION}
NEED_NAMES = {"VariableInserter", "VariableReplacer"}  # operators that need names of variables
SIGNS = {"Add", "Sub", "Mul", "Div", "FloorDiv", "Mod", "Pow"}  # the other binary ones are bitwise


@dataclass(frozen=True)
class Mutant:
    """A file with one change."""

    package: str
    path: Path
    node: int  # its number in cosmic-ray's walk
    operator: str
    index: int  # of the operator's variants for that node
    line: int
    column: int

    @property
    def place(self) -> str:
        """File and line, for messages."""
        return f"{self.path.relative_to(ROOT)}:{self.line}"

    @cached_property
    def source(self) -> str:
        """The file's text with the change."""
        tree = parso.parse(_text(self.path))
        node = next(islice(ast_nodes(tree), self.node, None))
        siblings = node.parent.children
        position = siblings.index(node)
        changed = _operators()[self.operator].mutate(node, self.index)
        siblings[position:position + 1] = [] if changed is None else [changed]
        return tree.get_code()

    @cached_property
    def lines(self) -> tuple[str, str]:
        """The lines that change, before and after, with single blanks."""
        difference = list(difflib.ndiff(_text(self.path).split("\n"), self.source.split("\n")))
        before, after = (" ".join(" ".join(line[2:] for line in difference if line[0] == sign)
                                  .split()) for sign in "-+")
        return before, after

    @property
    def key(self) -> str:
        """A key that changes with anything in the file."""
        return hashlib.sha256(f"{self.place}\n{self.source}".encode()).hexdigest()

    def runs(self) -> bool:
        """Whether it is valid Python, and differs from the original code."""
        try:
            return (ast.dump(ast.parse(self.source)) !=
                    ast.dump(ast.parse(_text(self.path))))
        except SyntaxError:
            return False


class Equal:
    """equal.yaml: changes without any effect, each with its reason."""

    def __init__(self, path: Path = Path(__file__).with_name("equal.yaml")) -> None:
        self._rows = yaml.safe_load(path.read_text("utf-8"))

    def why(self, mutant: Mutant) -> str | None:
        """The reason why the mutant is equal; None if it is not listed."""
        before, after = mutant.lines
        for row in self._rows["kinds"]:
            if re.fullmatch(row["before"], before) and re.fullmatch(row.get("after", ".*"), after):
                return row["why"]
        for row in self._rows["single"]:
            if (fnmatch(str(mutant.path), f"*/{row['file']}")
                    and (row["before"], row["after"]) == (before, after)):
                return row["why"]
        return None


def module_name(path: Path) -> str:
    """The module name of a file of the core; a file beside the tests has its stem as name."""
    for package in (SIMULATOR, NAVIGATION):
        if path.is_relative_to(package):
            words = path.relative_to(package.parent).with_suffix("").parts
            return ".".join(words).removesuffix(".__init__")
    return path.stem


def drawn(seed: int) -> Iterator[Mutant]:
    """One change at each place, in random order, all places being equally likely."""
    places: dict[tuple, list[Mutant]] = {}
    for package, folder in PACKAGES.items():
        for path in sorted(folder.rglob("*.py")):
            for mutant in mutants(package, path):
                places.setdefault((path, mutant.line, mutant.column), []).append(mutant)
    random = Random(seed)
    for place in random.sample(list(places), len(places)):
        choice = random.sample(places[place], len(places[place]))
        yield from islice((mutant for mutant in choice if mutant.runs()), 1)


def mutants(package: str, path: Path) -> Iterator[Mutant]:
    """All mutants of a file, including invalid Python; annotations are not changed."""
    text = _text(path)
    spared = list(_annotations(text))
    for number, node in enumerate(ast_nodes(parso.parse(text))):
        for name, operator in _operators().items():
            for index, ((line, column), _) in enumerate(operator.mutation_positions(node)):
                if not any(start <= (line, column) < end for start, end in spared):
                    yield Mutant(package, path, number, name, index, line, column)


def _annotations(text: str) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    for node in ast.walk(ast.parse(text)):
        for field in ("annotation", "returns"):
            if (found := getattr(node, field, None)) is not None:
                yield ((found.lineno, found.col_offset),
                       (found.end_lineno, found.end_col_offset))


@lru_cache
def _operators() -> dict[str, Operator]:
    """The operators that keep operations valid for their operands: any test notices `1.0 << 2`."""
    known = OperatorProvider()
    return {name: known[name]() for name in known
            if name not in NEED_NAMES and not _of_another_kind(name)}


def _of_another_kind(name: str) -> bool:
    words = name.split("_")
    return words[0] == "ReplaceBinaryOperator" and (words[1] in SIGNS) != (words[2] in SIGNS)


@lru_cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")
