"""Public functions name the errors that they raise, and rules name their source."""

import ast
import re
from pathlib import Path

from documented_errors import Sources

import bullet_sim.errors

CORE = Path(bullet_sim.errors.__file__).parent


def test_public_functions_name_the_errors_that_they_raise():
    sources = Sources.of(CORE)
    silent = [f"{module}:{line}" for module in sources.modules for line in sources.silent(module)]
    assert not silent, "the docstring does not say so:\n" + "\n".join(silent)


def test_the_check_sees_a_function_that_is_silent():
    sources = Sources({name: ast.parse(text) for name, text in {
        "errors": "class SimulationError(Exception):\n    pass\n"
                  "class FormatError(SimulationError):\n    pass\n",
        "low": "from errors import FormatError\n"
               "def f():\n    \"\"\"FormatError.\"\"\"\n    _g()\n"
               "def _g():\n    raise FormatError('no')\n"
               "class C:\n    def __init__(self):\n        _g()\n",
        "high": "from low import C, f as g\n"
                "def a():\n    g()\n"
                "def b():\n    \"\"\"A SimulationError.\"\"\"\n    C()\n"
                "def c():\n    try:\n        g()\n    except FormatError:\n        pass\n"
                "def d():\n    try:\n        C()\n    except KeyError:\n        pass\n"
                "class D(C):\n    def e(self):\n        super().__init__()\n"}.items()})
    assert sources.silent("low") == ["8: __init__ raises FormatError"]
    assert sources.silent("high") == [
        "2: a raises FormatError", "12: d raises FormatError", "18: e raises FormatError"]


def test_no_rule_is_as_upstream_without_a_place():
    vague = re.compile(r"\b[Uu]pstream(?!'s? [\w/ ]*\.(cpp|cc|hh|h|py)\b)")
    found = [f"{path.relative_to(CORE)}:{number}: {line.strip()}"
             for path in sorted(CORE.rglob("*.py"))
             for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
             if vague.search(line)]
    assert not found, "name the file and function:\n" + "\n".join(found)
