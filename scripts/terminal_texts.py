#!/usr/bin/env python3
"""Collects what our programs print, for the catalogues of src/interfaces/terminal_language.

    terminal_texts.py            adds new texts to the .po files, removes those that are gone, and
                                 writes the .mo files
    terminal_texts.py --compile  writes the .mo files only

Needs Debian's gettext. A text with values in it has {0}, {1} ... in the catalogue.
"""

from __future__ import annotations

import argparse
import ast
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOCALES = ROOT / "src/interfaces/terminal_language/src/terminal_language/locale"
KEPT = LOCALES / "kept.txt"  # upstream's sentences and texts that no terminal shows
LANGUAGE = "zh_CN"
# Programs for those who work on this repository, which print English.
INSTRUMENTS = re.compile(
    r"src/sim_bench/|src/interfaces/terminal_language/|src/trial_worlds/"
    r"|src/.*/(training|test)/"
    r"|src/.*/(setup|conftest|(draw|train)_\w+)\.py|src/sim/bullet_sim/examples/"
    r"|src/driving_courses/examples/|src/evaluation/src/evaluation/\w+_trials\.py")
# The page shows rviz's own words for its displays.
RVIZ = re.compile(r"src/sim/sim_viewer/src/sim_viewer/rviz/displays/")
SCRIPTS = ("scripts/own_packages.py",)  # setup runs them
WORD = re.compile(r"(?<![\w/.-])[A-Za-z]?[a-z']+(?![\w/-]|\.[a-z])")
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
FORMAT = re.compile(r"%(?:\(\w+\))?[-+0]*[0-9]*(?:\.[0-9]+)?[sdrfgix]|\{[^{} ]*\}")
PLACE = re.compile(r"\{\d+\}")
CONTEXT = "\4"  # gettext's, between a msgctxt and its msgid
# Of Python's argparse, which has no Chinese.
OF_ARGPARSE = (
    "usage: {0}", "positional arguments:", "options:", "show this help message and exit",
    "show program's version number and exit", "{0}: error: {1}", "argument {0}: {1}",
    "the following arguments are required: {0}", "unrecognized arguments: {0}",
    "invalid choice: {0} (choose from {1})", "invalid {0} value: {1}",
    "invalid float value: {0}", "invalid int value: {0}",
    "expected one argument", "expected at least one argument", "expected {0} arguments",
    "not allowed with argument {0}", "one of the arguments {0} is required")
# Of the system, by the error numbers that a learner meets.
OF_SYSTEM = (
    "No such file or directory", "Permission denied", "Is a directory", "Not a directory",
    "File exists", "No space left on device", "Connection refused", "[Errno {0}] {1}: {2}")
# Of rospy and of turtlesim's answer in it.
OF_ROSPY = ("service [{0}] responded with an error: b'service cannot process request: {1}'",
            "A turtle named [{0}] already exists")
# Of Tk.
OF_TK = ("no display name and no $DISPLAY environment variable",
         "couldn't connect to display {0}")
# Of expat, before a line and column.
OF_EXPAT = ("not well-formed (invalid token)", "mismatched tag", "no element found",
            "unclosed token", "duplicate attribute", "junk after document element")
# Of catkin, before expat's words.
OF_CATKIN = ("The manifest contains invalid XML: {0}",)
# Of Python's reader of scripts, in the words of 3.11 to 3.13.
OF_PYTHON = (
    "invalid syntax", "invalid syntax. Perhaps you forgot a comma?",
    "invalid syntax. Maybe you meant '==' or ':=' instead of '='?",
    "cannot assign to {0} here. Maybe you meant '==' instead of '='?", "cannot assign to {0}",
    "unexpected indent", "expected '{0}'", "expected '('", "expected 'except' or 'finally' block",
    "{0} was never closed", "unmatched {0}", "'{0}' statement",
    "closing parenthesis {0} does not match opening parenthesis {1}",
    "closing parenthesis {0} does not match opening parenthesis {1} on line {2}",
    "unterminated string literal (detected at line {0})",
    "unterminated triple-quoted string literal (detected at line {0})",
    "expected an indented block after {0} on line {1}", "expected an indented block",
    "unindent does not match any outer indentation level",
    "inconsistent use of tabs and spaces in indentation",
    "Missing parentheses in call to '{0}'. Did you mean {1}?",
    "multiple exception types must be parenthesized",
    "leading zeros in decimal integer literals are not permitted; use an 0o prefix for octal "
    "integers",
    "invalid character '{0}' ({1})", "invalid non-printable character {0}",
    "invalid decimal literal", "'{0}' outside function", "'{0}' outside loop",
    "unexpected character after line continuation character", "keyword argument repeated: {0}",
    "positional argument follows keyword argument", "source code string cannot contain null bytes",
    "duplicate argument '{0}' in function definition", "expecting '}'",
    "empty expression not allowed", "single '}' is not allowed",
    "expecting a valid expression after '{'", "valid expression required before '}'")
# Of PyYAML.
OF_YAML = ("expected '{0}' or '{1}', but got '{2}'", "expected '{0}', but found '{1}'",
           "{0} in \"<unicode string>\", line {1}, column {2}: {3}")
# Of shell scripts that `python3 -m terminal_language` translates, as the terminal is a learner's.
OF_SHELL = (
    "rosed: {0} is not installed; {1} opens {2}", "rosed: {0} has no screen here; {1} opens {2}",
    "rosed: {0} is not installed, and no other editor is installed; type: sudo apt-get install "
    "nano",
    "rosed: {0} has no screen here, and no other editor is installed; type: sudo apt-get install "
    "nano",
    "{0} {1} is in C++ and not built yet; type: make -C {2} build CPP=1",
    "No ROS master: first type make sim in another terminal.",  # of lane_keeping's Makefile
    "No simulator runs: first type make sim in another terminal.",
    "No bridge is needed: the simulator's topics are ROS 1 topics.")
ABSENT = "src/workspace_needs/data/absent.yaml"
CHECK = "src/workspace_needs/src/workspace_needs/check/findings.py"
# Words in the tables and progress lines of evaluation and marking (terminal_language.heading).
OF_TABLES = (
    "  follower", "laps", "lap s", "RMS cm", "max cm", "sent", "dropped", "real time", "outcome",
    "goal", "reached", "straight s", "shortest s", "off cm", "off °", " points", "student",
    "points", "of", "sandbox", "note", "path", "film", "Marks",
    "halls", "contact", "mean time, s", "slowest, s", "nearest, m",
    "file", "robot", "world", "scripts",  # and of check
    "mission", "passed", "after s", "contacts", "why not", "yes", "mapping", "goals", "standing")
# Of progress lines, whose frame has few words.
OF_PROGRESS = ("way-point {0}/{1}", "goal {0}/{1}", "{0}, {1} m off",
               "lap finished", "{0} laps finished", "track {0}, seed {1}", "{0} of {1} points",
               "replay in 3D", "it called {0}", "it published {0}", "exit code {0}",
               "closed", "stalled", "time is up", "ended early",
               "subscribed to {0}", "advertised {0}", "made {0}", "not allowed", "not run",
               "fault", "preview: {0}", "next:", "{0} cm and {1}°", "{0}, scene {1}, seed {2}",
               "kept", "driven", "following", "waiting", "searching", "{0} not reached",
               "goal {0} ({1}, {2})", "way-point {0} ({1}, {2})")
# Of an exercise's findings, whose values may be a word.
OF_FINDINGS = ("pass  {0}", "FAIL  {0}", "{0}, wanted {1}", "at least {0}", "at most {0}",
               "messages", "there", "missing", "drives", "stands", "{0} poses")
# Of lists that a file's faults stand in, whose frame has one word.
OF_LISTS = ("one of {0}", "controller {0}", "File is not a zip file", "Ctrl-C ends.", "line {0}",
            "line {0}: {1}", "line {0}, column {1}", "left out",
            "line {0}, column {1} (file {2})", "line {0}, column {1}: {2}", "write &amp; for &",
            "write &gt; for >", "it must be a whole number of pixels, 1 or more",
            "link of model {0}", "joint of model {0}", "{0} when evaluating expression {1}",
            "camera_width is {0}", "camera_height is {0}", "Commands:",
            "WRONG  {0}. Type: {1}", "map on {0}", "laser scans on {0}", "there are: {0}",
            "is {0} meant?",
            'not yet: "{0}" passed to lookupTransform argument {1} does not exist.')
# Of missing_headers.cmake.
OF_CMAKE = ("{0}: target {1} is left out: {2}. What the simulator has in its place: {3}",
            "{0}: <{1}> is included, but CMakeLists.txt does not name {2} in find_package(catkin "
            "... COMPONENTS ...): found all the same")
# Values of sentences, which may be names elsewhere.
OF_VALUES = ("none", "unknown", "a number", "a text", "this user", "parent link", "child link",
             "link", "joint", "model", "sensor", "function call", "function definition",
             "class definition", "literal", "expression", "attribute", "simulated clock /clock",
             "the disk", "<input>", "driving",
             "scene", "tracker", "follower", "mission", "operation",
             "method", "avoider", "reached", "contact", "late",
             "Graph", "Plot", "Cameras", "Console", "TF", "Bags", "Topics", "Drive", "Services",
             "Parameters")
OF_CHECK = ("PROBLEM", "NOT THERE", "not checked", "approximated", "hint", "ignored",
            "works",  # its words
            "world {0} ({1} models)", "model {0} ({1} links, {2} joints)", "the text",
            "{0}. Arg xml is {1}", "while processing {0}: {1}",  # roslaunch's
            "<{0}> tag is missing required attribute: {1}. Node xml is {2}",
            "error loading <rosparam> tag: {0} XML is {1}", "file does not exist [{0}]",
            "Invalid <param> tag: {0}. Param xml is {1}", 'Unknown CMake command "{0}".',
            "Assertion failed: file '{0}' does not exist. Message: {1}",
            "Cannot locate message [{0}] in package [{1}] with paths {2}",
            "{0} includes <{1}>, and the C++ API of Gazebo is not here",
            "{0} packages: all that Debian has for them is installed",  # of deps
            "{0} packages: to be installed: {1}", "{0} packages: installing {1}",
            "1 package: all that Debian has for them is installed",
            "1 package: to be installed: {0}", "1 package: installing {0}")


def texts_of(source: str) -> Iterator[str]:
    """The texts in a Python source that may reach a terminal, a line each.

    What is printed, logged or raised there counts if it has a word and a space; every other string
    if it has three words, since it may be returned to who does so. Docstrings are none, unless
    argparse's description is the file's.
    """
    tree = ast.parse(source)
    if _shows_docstring(tree):
        yield " ".join(ast.get_docstring(tree).split())
    docstrings = {id(node.body[0].value) for node in ast.walk(tree)
                  if isinstance(node, DOCUMENTED)
                  and node.body and isinstance(node.body[0], ast.Expr)}
    shown = {id(string) for node in ast.walk(tree) if is_door(node) for string in _strings(node)}
    for node in _strings(tree):
        for line in sentence(node).split("\n") if id(node) not in docstrings else ():
            words = len(WORD.findall(PLACE.sub("", line)))
            if words >= (1 if id(node) in shown else 3) and " " in line.strip() and is_text(line):
                yield line.strip()


def _shows_docstring(tree: ast.Module) -> bool:
    return any(isinstance(node, ast.keyword) and node.arg == "description"
               and isinstance(node.value, ast.Name) and node.value.id == "__doc__"
               for node in ast.walk(tree))


def is_door(node: ast.AST) -> bool:
    """Whether a statement or call shows its texts to the user."""
    if isinstance(node, ast.Raise):
        return True
    if isinstance(node, ast.keyword):
        return node.arg in ("help", "description", "epilog")
    called = node.func if isinstance(node, ast.Call) else None
    name = getattr(called, "attr", getattr(called, "id", ""))
    return name.startswith("log") or name in (
        "print", "exit", "error", "info", "warning", "input", "say", "status", "Finding",
        "near", "holds", "at_least", "at_most")


def _strings(node: ast.AST) -> Iterator[ast.expr]:
    """Strings below a node, sums of strings and others as one, and those within their values."""
    if isinstance(node, ast.JoinedStr) or _is_sum(node):
        yield node
        for part in _parts(node):
            if not isinstance(part, ast.Constant):
                yield from _strings(part)
    elif isinstance(node, ast.Constant):
        if isinstance(node.value, str):
            yield node
    else:
        for child in ast.iter_child_nodes(node):
            yield from _strings(child)


def _is_sum(node: ast.AST) -> bool:
    return (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add)
            and any(isinstance(part, ast.Constant) and isinstance(part.value, str)
                    for part in _parts(node)))


def _parts(node: ast.AST) -> list[ast.AST]:
    """Constants and values of an f-string, or of a sum."""
    if isinstance(node, ast.JoinedStr):
        return [part for value in node.values for part in _parts(value)]
    if isinstance(node, ast.FormattedValue):
        return [node.value]
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return _parts(node.left) + _parts(node.right)
    return [node]


def sentence(node: ast.expr) -> str:
    """A string with {0}, {1} ... in place of its values."""
    if isinstance(node, ast.Constant):
        text = FORMAT.sub("{}", node.value).replace("%%", "%")
    else:
        text = "".join(part.value if isinstance(part, ast.Constant) and isinstance(part.value, str)
                       else "{}" for part in _parts(node))
    pieces = text.split("{}")
    return "".join(f"{piece}{{{at}}}" for at, piece in enumerate(pieces[:-1])) + pieces[-1]


def is_text(text: str) -> bool:
    """Whether a string is words rather than a pattern, a piece of a file or of a program."""
    return not NO_TEXT.search(text.strip())


NO_TEXT = re.compile(
    r"^<[!?/]|^(\{\d+\} *)?<\w+( name=\{0\})?( [\w:]+=\"|>?$|>[^,]*</)"
    r"|[\\^]|\|(?! )|(?<! )\||\w\[\w|^import |^# |^/|^~\S*$|^\w+\{[\w-]+:\w")


@cache
def python_texts() -> dict[str, list[str]]:
    """Each text that a program prints, and the files that it is in."""
    found: dict[str, list[str]] = {text: ["Python's argparse"] for text in OF_ARGPARSE}
    found |= {text: ["the system"] for text in OF_SYSTEM}
    found |= {text: ["rospy"] for text in OF_ROSPY}
    found |= {text: ["Tk"] for text in OF_TK}
    found |= {text: ["expat"] for text in OF_EXPAT}
    found |= {text: ["catkin"] for text in OF_CATKIN}
    found |= {text: ["Python"] for text in OF_PYTHON}
    found |= {text: ["PyYAML"] for text in OF_YAML}
    found |= {text: [CHECK] for text in OF_CHECK}
    found |= {f"column{CONTEXT}{word}": ["tables"] for word in OF_TABLES}
    found |= {f"value{CONTEXT}{word}": ["values"] for word in OF_VALUES}
    found |= {text: ["progress-lines"] for text in OF_PROGRESS}
    found |= {text: ["findings"] for text in OF_FINDINGS}
    found |= {text: ["lists-of-faults"] for text in OF_LISTS}
    found |= {text: ["rosed-and-rosrun"] for text in OF_SHELL}
    found |= {text: ["missing_headers.cmake"] for text in OF_CMAKE}
    found |= {text: [ABSENT] for text in absences()}
    found |= {text: ["params-of-navigation"] for text in meanings()}
    listed = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files", "-co", "--exclude-standard", "src", "tools/lab"],
        capture_output=True, text=True, check=True).stdout.split("\n")
    for name in sorted({*listed, *SCRIPTS}):
        path = ROOT / name
        if INSTRUMENTS.match(name) or RVIZ.match(name) or path.is_symlink() or not path.is_file():
            continue
        with path.open("rb") as file:
            first = file.readline(80)
        if name.endswith(".py") or (first.startswith(b"#!") and b"python" in first):
            for text in texts_of(path.read_text(encoding="utf-8")):
                if name not in found.setdefault(text, []):
                    found[text].append(name)
    for text in kept():
        found.pop(text, None)
    return found


def absences() -> list[str]:
    """Why nobody has a package: rosdep, check and the build print that."""
    return re.findall(r"^  why: (.*)", (ROOT / ABSENT).read_text(encoding="utf-8"), re.MULTILINE)


def meanings() -> list[str]:
    """Why parameters of navigation have no effect."""
    return sorted({found for path in ROOT.glob("src/navigation/*/params/*.yaml")
                   for found in re.findall(r'status: accepted, meaning: "(.*)"}',
                                           path.read_text(encoding="utf-8"))})


def kept() -> list[str]:
    """Texts that stay English."""
    lines = KEPT.read_text(encoding="utf-8").split("\n")
    return [line for line in lines if line and not line.startswith("#")]


def shell_texts() -> dict[str, list[str]]:
    """The shell scripts' texts, written as $"...", and the Makefile's list of commands."""
    found: dict[str, list[str]] = {}
    for path in (*sorted(ROOT.glob("scripts/*.sh")), *sorted(ROOT.glob("scripts/setup/*.sh"))):
        told = subprocess.run(["bash", "--dump-po-strings", str(path)], capture_output=True,
                              text=True, check=True).stdout
        for text in re.findall(r'^msgid "(.*)"$', told, re.MULTILINE):
            found.setdefault(unquoted(text), []).append(str(path.relative_to(ROOT)))
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for text in re.findall(r"^[a-z-]+:.*?##+ (.*)", makefile, re.MULTILINE):
        found.setdefault(text, []).append("Makefile")
    return found


def quoted(text: str) -> str:
    """As .po files write it."""
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\t", "\\t")


def unquoted(text: str) -> str:
    return re.sub(r"\\(.)", lambda found: {"n": "\n", "t": "\t"}.get(found[1], found[1]), text)


def template(found: dict[str, list[str]]) -> str:
    """A .pot file."""
    head = 'msgid ""\nmsgstr "Content-Type: text/plain; charset=UTF-8\\n"\n'
    return head + "".join(
        f'\n#: {" ".join(name.replace(" ", "-") for name in files)}\n'
        f'{_context(text)}msgid "{quoted(text.split(CONTEXT)[-1])}"\nmsgstr ""\n'
        for text, files in sorted(found.items(), key=lambda each: (each[1][0], each[0])))


def _context(text: str) -> str:
    context = text.split(CONTEXT)[:-1]
    return f'msgctxt "{context[0]}"\n' if context else ""


def merge(domain: str, found: dict[str, list[str]]) -> None:
    """Bring a .po file up to date; what it has stays."""
    path = LOCALES / f"{domain}.po"
    with tempfile.NamedTemporaryFile("w", suffix=".pot", encoding="utf-8") as pot:
        pot.write(template(found))
        pot.flush()
        if not path.exists():
            path.write_text(template({}), encoding="utf-8")
        subprocess.run(["msgmerge", "--quiet", "--no-fuzzy-matching", "--no-wrap", "--update",
                        "--backup=off", str(path), pot.name], check=True)
    subprocess.run(["msgattrib", "--no-obsolete", "--no-wrap", "-o", str(path), str(path)],
                   check=True)


def compile_catalogue(domain: str, folder: Path) -> None:
    """Write a .mo file into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["msgfmt", "--no-hash", str(LOCALES / f"{domain}.po"), "-o",
                    str(folder / f"{domain}.mo")], check=True)


DOMAINS = {"courses": python_texts, "courses-shell": shell_texts}


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--compile", action="store_true", help="write the .mo files only")
    only_compile = parser.parse_args().compile
    for domain, collect in DOMAINS.items():
        if not only_compile:
            merge(domain, collect())
        compile_catalogue(domain, LOCALES / LANGUAGE / "LC_MESSAGES")
    return 0


if __name__ == "__main__":
    sys.exit(main())
