"""Finds the first error in a build's output, in the build tools' own lines.

    build_cause.py LOG        prints at most six lines; nothing if it finds none
"""

from __future__ import annotations

import itertools
import re
import sys
import textwrap
from pathlib import Path

MOST = 6
COMPILER = re.compile(r"^\S+:\d+(:\d+)?: (fatal )?error: ")
LINKER = re.compile(r"undefined reference to |ld: cannot find ")
CMAKE = re.compile(r"^CMake Error")
GLUED = re.compile(r"(?<=[^\n])(?=CMake Error (?:at|in) \S+:\d+ \()")  # to what has no line end
CMAKE_HEAD = re.compile(r"^CMake Error(?: (?:at|in) (\S+?(?::\d+)?))?(?: \(\w+\))?:\s*")
CMAKE_CALLER = re.compile(r"^  (\S+:\d+) \(\w+\)$")
LONGEST = 240  # characters of an error in one line
UNKNOWN_COMMAND = re.compile(r'Unknown CMake command "(\w+)"')
OF_PACKAGES = {  # commands of packages that learners forget in find_package
    **dict.fromkeys(("add_message_files", "add_service_files", "add_action_files",
                     "generate_messages"), "message_generation"),
    "generate_dynamic_reconfigure_options": "dynamic_reconfigure", "add_rostest": "rostest"}
GENMSG = "Cannot locate"
NOT_FOUND = re.compile(r'provided by "([^"]+)"|required component \'([^\']+)\'')
GENERATOR = re.compile(r"^(catkin_make: |ERROR|Error|.*Error\(s\) in |.*RuntimeError: |"
                       r".*InvalidPackage|Multiple packages found|The workspace contains|"
                       r".*SyntaxError: )")
PYTHON = re.compile(r"^Traceback \(most recent call last\):")
STOPPED = re.compile(r"No space left on device|virtual memory exhausted|Killed signal|"
                     r"^c\+\+: fatal error: ")


def block(lines: list[str]) -> list[str]:
    """A CMake error's paragraphs up to its call stack, without blank lines."""
    kept = [lines[0]]
    for line in lines[1:]:
        if line.startswith(("Call Stack", "-- ", "CMake ")) or (line and not line.startswith(" ")):
            break
        if line.strip():
            kept.append(line)
    return kept


def compiler_block(lines: list[str]) -> list[str]:
    """A compiler's error and the source line that it shows."""
    kept = [lines[0]]
    for line in lines[1:3]:
        if not re.match(r"^ +\d* *\|", line):
            break
        kept.append(line)
    return kept


def traceback_block(lines: list[str]) -> list[str]:
    """The last file that a Python traceback names, and its error."""
    for position, line in enumerate(lines[1:], 1):
        if line and not line.startswith(" "):
            files = [text for text in lines[1:position] if text.lstrip().startswith("File ")]
            return [*files[-1:], line]
    return lines[:2]


def cause(text: str) -> list[str]:
    """The lines on the first error in a build's output; none if nothing looks like one."""
    lines = GLUED.sub("\n", text).splitlines()
    for position, line in enumerate(lines):
        rest = lines[position:]
        if CMAKE.search(line):
            return block(rest)[:MOST]
        if COMPILER.search(line) or STOPPED.search(line):
            return compiler_block(rest)
        if LINKER.search(line):
            return [line]
        if PYTHON.search(line):
            return traceback_block(rest)
        if GENERATOR.search(line):
            return [line for line in rest[:MOST] if line.strip()][:3]
    return []


def in_one_line(text: str) -> str:
    """The first error in the output of CMake, run on one package, with its place in the package."""
    text = GLUED.sub("\n", text)
    first = cause(text)
    if not first:
        return (text.strip().splitlines() or ["CMake ended without a word"])[-1]
    place = ""
    if head := CMAKE_HEAD.match(first[0]):
        lines = text.splitlines()
        lines = lines[lines.index(first[0]):]
        callers = (match.group(1) for match in map(CMAKE_CALLER.match, lines) if match)
        # Paths of the package are relative; those of catkin and CMake, which it calls, absolute.
        place = next((path for path in [head.group(1) or "/", *callers] if path[0] != "/"), "")
        first = [lines[0][head.end():], *itertools.takewhile(_goes_on, lines[1:])]
        if GENMSG in text:  # the first paragraph only asks
            first = [text[text.index(GENMSG):].partition("\n\n")[0].partition("\nCall")[0]]
        elif not "".join(first).strip() or first[-1].endswith(":"):
            # CMake names what it means in the next paragraph
            after = itertools.dropwhile(lambda line: not line.strip(), lines[len(first):])
            first += itertools.takewhile(_goes_on, after)
    said = textwrap.shorten(" ".join(first), LONGEST, placeholder=" ...")
    if (command := UNKNOWN_COMMAND.search(said)) and (package := OF_PACKAGES.get(command[1])):
        said = f"{said} Add {package} to find_package(catkin REQUIRED COMPONENTS ...)"
    return f"{place}: {said}" if place else said


def _goes_on(line: str) -> bool:
    return bool(line.strip()) and not line.startswith("Call Stack")


def advice(lines: list[str]) -> str | None:
    """What to type if a package is missing; else None."""
    found = NOT_FOUND.search(" ".join(line.strip() for line in lines))  # CMake wraps its lines
    if not found:
        return None
    name = found.group(1) or found.group(2)
    return f"{name} is not installed: `make deps` installs it, or says why nobody has it"


def main() -> int:
    """Always returns 0: the build has failed already."""
    lines = cause(Path(sys.argv[1]).read_text(errors="replace"))
    for line in lines:
        print(f"  {line}")
    if hint := advice(lines):
        print(f"  {hint}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
