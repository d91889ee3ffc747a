"""Which errors leave a public function, and which of them its docstring does not name.

Calls are followed through `from x import f`, to private functions and to methods of `self`; what
is called through another object is not. A docstring may name a base class instead, and a base
class speaks for methods without a docstring.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from pathlib import Path

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
Function = ast.FunctionDef | ast.AsyncFunctionDef
ANY = {"Exception", "BaseException"}
BUGS = {"TypeError", "InterfaceError"}  # of a caller, of our own tables


@dataclass(frozen=True)
class Place:
    """A function or class, with the module and class that it stands in."""

    module: str
    node: Function | ast.ClassDef
    owner: Place | None = None

    @property
    def doc(self) -> str:
        return ast.get_docstring(self.node) or ""


@dataclass
class Sources:
    """Parsed modules by dotted name."""

    modules: dict[str, ast.Module]
    bases: dict[str, set[str]] = field(default_factory=dict)  # class name: names of its bases
    _made: dict[tuple[str, str], Place] = field(default_factory=dict)  # at the top of a module
    _imported: dict[tuple[str, str], tuple[str, str]] = field(default_factory=dict)
    _found: dict[int, frozenset[str]] = field(default_factory=dict)

    def __post_init__(self):
        for module, tree in self.modules.items():
            for node in tree.body:
                if isinstance(node, (*FUNCTIONS, ast.ClassDef)):
                    self._made[module, node.name] = Place(module, node)
            for node in ast.walk(tree):
                if isinstance(node, ast.ClassDef):
                    self.bases[node.name] = {name_of(base) for base in node.bases}
                elif isinstance(node, ast.ImportFrom) and node.module:
                    for alias in node.names:
                        self._imported[module, alias.asname or alias.name] = (
                            node.module, alias.name)

    @classmethod
    def of(cls, *folders: Path) -> Sources:
        """Of packages in these folders, `.../src/NAME` each."""
        found = {}
        for folder in folders:
            for path in sorted(folder.rglob("*.py")):
                words = path.relative_to(folder.parent).with_suffix("").parts
                name = ".".join(words[:-1] if words[-1] == "__init__" else words)
                found[name] = ast.parse(path.read_text(encoding="utf-8"))
        return cls(found)

    def names(self, error: str) -> set[str]:
        """The class's own name and those of all that it derives from."""
        return {error}.union(*map(self.names, self.bases.get(error, ())))

    def silent(self, module: str) -> list[str]:
        """Public functions of a module that raise without saying so."""
        tree, lines = self.modules[module], []
        classes = [Place(module, node) for node in tree.body if isinstance(node, ast.ClassDef)
                   and not node.name.startswith("_")]
        for owner in [None, *classes]:
            for node in (owner.node if owner else tree).body:
                if isinstance(node, FUNCTIONS):
                    lines += self._silent(Place(module, node, owner))
        return lines

    def _silent(self, function: Place) -> list[str]:
        name, owner, said = function.node.name, function.owner, function.doc
        bases = self._bases(owner) if owner else []
        if not said:
            said = "".join(base.doc for base in bases)
        if name == "__init__":
            if owner.node.decorator_list:
                return []  # what is registered, as by @plugin(...): said where it is made
            said += owner.doc + "".join(base.doc for base in bases)
        elif name.startswith("_"):
            return []
        return [f"{function.node.lineno}: {name} raises {error}"
                for error in sorted(self.raised(function))
                if not any(each in said for each in self.names(error))]

    def raised(self, place: Place) -> frozenset[str]:
        """Class names of the errors that leave a function, or the making of an object."""
        if isinstance(place.node, ast.ClassDef):
            made = self._member(place, "__init__") or self._member(place, "__post_init__")
            return self.raised(made) if made else frozenset()
        if id(place.node) not in self._found:
            self._found[id(place.node)] = frozenset()  # a recursive call adds nothing
            self._found[id(place.node)] = frozenset(self._leaving(place.node.body, place))
        return self._found[id(place.node)]

    def _leaving(self, nodes: list[ast.AST], place: Place) -> set[str]:
        return set().union(*(self._leave(node, place) for node in nodes))

    def _leave(self, node: ast.AST, place: Place) -> set[str]:
        if isinstance(node, (*FUNCTIONS, ast.Lambda, ast.ClassDef)):
            return set()  # made here, called elsewhere
        if isinstance(node, ast.Try):
            caught = self._leaving(node.body, place)
            for handler in node.handlers:
                if not any(isinstance(each, ast.Raise) and each.exc is None
                           for each in ast.walk(handler)):
                    caught -= self._caught(caught, handler.type)
            return caught | self._leaving([*node.handlers, *node.orelse, *node.finalbody], place)
        if isinstance(node, ast.With):
            left = self._leaving(node.body, place)
            for item in node.items:
                call = item.context_expr
                if isinstance(call, ast.Call) and name_of(call.func) == "suppress":
                    left -= self._caught(left, call)
            return left | self._leaving(node.items, place)
        found = self._leaving(list(ast.iter_child_nodes(node)), place)
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call | ast.Name):
            found.add(name_of(node.exc.func if isinstance(node.exc, ast.Call) else node.exc))
        elif isinstance(node, ast.Call):
            called = self._called(node.func, place)
            found |= (self.raised(called) if called else set()) & self.bases.keys() - BUGS
        return {name for name in found if name[:1].isupper()}

    def _caught(self, errors: set[str], kind: ast.AST | None) -> set[str]:
        kinds = ANY if kind is None else {name_of(node) for node in ast.walk(kind)}
        return {error for error in errors if kinds & (self.names(error) | ANY)}

    def _called(self, function: ast.AST, place: Place) -> Place | None:
        if isinstance(function, ast.Name):
            return self._find(place.module, function.id)
        if not isinstance(function, ast.Attribute):
            return None
        holder, name = function.value, function.attr
        if isinstance(holder, ast.Call) and name_of(holder.func) == "super" and place.owner:
            return self._inherited(place.owner, name)
        if not isinstance(holder, ast.Name):
            return None
        if holder.id in ("self", "cls") and place.owner:
            return self._member(place.owner, name)
        owner = self._find(place.module, holder.id)
        if owner is not None:
            return self._member(owner, name) if isinstance(owner.node, ast.ClassDef) else None
        module = self._imported.get((place.module, holder.id))
        return self._find(".".join(module), name) if module else None

    def _find(self, module: str, name: str) -> Place | None:
        """What a name at the top of a module is, followed through imports."""
        found = self._made.get((module, name))
        if found is None and (module, name) in self._imported:
            return self._find(*self._imported[module, name])
        return found

    def _member(self, owner: Place, name: str) -> Place | None:
        for node in owner.node.body:
            if isinstance(node, FUNCTIONS) and node.name == name:
                return Place(owner.module, node, owner)
        return self._inherited(owner, name)

    def _inherited(self, owner: Place, name: str) -> Place | None:
        return next(filter(None, (self._member(base, name) for base in self._bases(owner))), None)

    def _bases(self, owner: Place) -> list[Place]:
        """Base classes that are ours, each with its own."""
        found = [self._find(owner.module, name_of(base)) for base in owner.node.bases]
        return [each for base in filter(None, found) for each in (base, *self._bases(base))]


def name_of(node: ast.AST) -> str:
    """`c` of `a.b.c` and of `c`."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""
