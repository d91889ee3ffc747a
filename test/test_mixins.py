"""A class of the simulator is split by having parts, never by mixins (test_arrows.py: imports)."""

import ast
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

SIM = Path(__file__).resolve().parent.parent / "src" / "sim"


def sources() -> list[str]:
    return [path.read_text(encoding="utf-8") for path in sorted(SIM.glob("*/src/**/*.py"))]


def names(nodes: Iterable[ast.expr]) -> list[str]:
    """The last words of names and dotted names."""
    return [node.attr if isinstance(node, ast.Attribute) else node.id for node in nodes
            if isinstance(node, (ast.Attribute, ast.Name))]


def used(nodes: list[ast.AST]) -> set[str]:
    """Names that occur as values: beside base classes and annotations."""
    aside = [part for node in nodes for part in (
        *getattr(node, "bases", ()), getattr(node, "annotation", None),
        getattr(node, "returns", None)) if part is not None]
    left_out = {id(inner) for part in aside for inner in ast.walk(part)}
    return set(names(node for node in nodes if id(node) not in left_out))


def mixins(texts: list[str]) -> list[str]:
    """Classes that are only a part of one other class, and classes made of several of ours."""
    nodes = [node for text in texts for node in ast.walk(ast.parse(text))]
    classes = {node.name: names(node.bases) for node in nodes if isinstance(node, ast.ClassDef)}
    own = used(nodes)
    heirs = Counter(base for bases in classes.values() for base in bases)
    parts = [name for name, bases in classes.items()
             if heirs[name] == 1 and name not in own and not {"ABC", "Exception"} & set(bases)]
    several = [name for name, bases in classes.items()
               if sum(base in classes for base in bases) > 1]
    return sorted({*parts, *several})


def test_no_class_is_cut_into_mixins() -> None:
    found = mixins(sources())
    assert not found, f"{', '.join(found)}: let the class have a part instead of inheriting it"


def test_the_check_itself() -> None:
    chain = "class State: ...\nclass Model(State): ...\nModel()"
    assert mixins([chain]) == ["State"]
    assert mixins([chain, "State()"]) == []  # a class in its own right
    two = "class A: ...\nclass B: ...\nclass C(A, B): ...\nA(), B(), C()"
    assert mixins([two]) == ["C"]
    assert mixins(["class Plan(ABC): ...\nclass Own(m.Plan): ..."]) == []  # abstract
