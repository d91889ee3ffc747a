"""`catkin_make`, `catkin_make_isolated` and `catkin build`, as tutorials type them.

A package with a dependency that nobody provides must not stop the others: catkin_make configures
all packages in one run of CMake, which ends at the first missing component, and the other two fail
at that package. So such packages are left out, with a printed line, by each tool's own means:
CATKIN_BLACKLIST_PACKAGES, --ignore-pkg, the skiplist. The lines are printed again once the tool has
ended. All learners' packages are configured with missing_headers.cmake, which mends what upstream's
headers allow and Debian's do not.
"""

from __future__ import annotations

import itertools
import os
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

from workspace_needs.places import hook
from workspace_needs.verdicts import Verdict, judge
from workspace_needs.workspace import WorkspaceError, hide

FOLDER = "/usr/bin"  # where Debian's own commands are
PATIENCE = 2  # s after Ctrl-C, in which the tool ends by itself
CHOSEN = ("--pkg", "--from-pkg")  # catkin_make_isolated takes no --ignore-pkg with these


def catkin_make() -> NoReturn:
    """Runs Debian's catkin_make."""
    _run("catkin_make", *catkin_make_words(sys.argv[1:]))


def catkin_make_words(args: list[str]) -> tuple[list[str], LeftOut]:
    """`args`, with options that leave out packages, unless `args` choose packages themselves."""
    if any("BLACKLIST_PACKAGES" in word for word in args):
        return [*hook(), *args], LeftOut()
    left = left_out("catkin_make", args, _source(args))
    return [*hook(), f"-DCATKIN_BLACKLIST_PACKAGES={';'.join(left.names)}", *args], left


def catkin_make_isolated() -> NoReturn:
    """Runs Debian's catkin_make_isolated."""
    _run("catkin_make_isolated", *catkin_make_isolated_words(sys.argv[1:]))


def catkin_make_isolated_words(args: list[str]) -> tuple[list[str], LeftOut]:
    """`args`, with options that leave out packages, unless `args` choose packages themselves."""
    if {word.partition("=")[0] for word in args} & set(CHOSEN):
        return [*hook(), *args], LeftOut()
    left = left_out("catkin_make_isolated", args, _source(args))
    if not left.names:
        return [*hook(), *args], left
    option = "--ignore-pkg"
    place = args.index(option) + 1 if option in args else 0
    # Not after --cmake-args, which takes all that follows.
    words = [*hook(), *args[:place], *([] if place else [option]), *left.names, *args[place:]]
    return words, left


def catkin() -> int:
    """Runs catkin_tools, from Debian or PyPI; its `build` leaves out packages as the others do."""
    args = sys.argv[1:]
    try:
        from catkin_tools.commands.catkin import main
        from catkin_tools.verbs.catkin_build import cli
    except ImportError:
        _become_another_catkin(args)
        print("catkin: catkin_tools is not installed: sudo apt-get install catkin-tools "
              "(or build with catkin_make)", file=sys.stderr)
        return 127

    class BuildContext(cli.Context):
        """The settings of one build; left-out packages are not saved by --save-config."""

        left = LeftOut()

        @classmethod
        def load(cls, *words, **options):
            context = super().load(*words, **options)
            if context and "--get-env" not in args:
                cls.left = left_out("catkin build", args, Path(context.source_space_abs))
                context.skiplist = [*context.skiplist, *cls.left.names]
                context.cmake_args = [*context.cmake_args, *hook()]
            return context

        @classmethod
        def save(cls, context):
            context.skiplist = [name for name in context.skiplist if name not in cls.left.names]
            context.cmake_args = [word for word in context.cmake_args if word not in hook()]
            super().save(context)
            context.skiplist = [*context.skiplist, *cls.left.names]
            context.cmake_args = [*context.cmake_args, *hook()]

    cli.Context = BuildContext
    try:
        code = main(args)
    except SystemExit as ended:
        code = ended.code
    return BuildContext.left.end(code)


@dataclass
class LeftOut:
    """The packages that a build leaves out."""

    names: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)  # what is said of them
    are_all: bool = False  # whether nothing else was asked for

    def end(self, code: str | int | None) -> str | int | None:
        """Repeats the lines, which have scrolled away; the exit code for that of the tool."""
        print(*self.lines, sep="\n", end="\n" * bool(self.lines), flush=True)
        if code or not self.are_all:
            return code
        return ("nothing of your own is built: each package that was asked for is left out, "
                "see above")


def left_out(tool: str, args: list[str], source: Path) -> LeftOut:
    """The packages below `source` that cannot be built; prints a line for each.

    Ends the program with one line if no tool would build anything. A missing folder is left for the
    tool to report.
    """
    if {"-h", "--help"} & set(args) or not source.is_dir():
        return LeftOut()
    ours = (source / "compat/names.yaml").is_file()  # this repository, perhaps after a `git pull`
    if ours:
        subprocess.run([sys.executable, "-B", source.parent / "tools/makers", "name_packages"],
                       stdout=subprocess.DEVNULL, check=False)
    try:
        verdicts = judge(source, words=args, now=True)
        for verdict in verdicts:
            if verdict.hides_ours:
                hide(verdict.folder)
            if tool == "catkin_make":
                verdict.stops.update(verdict.clashes)
    except (WorkspaceError, OSError) as error:
        sys.exit(f"{tool}: {error}")
    stopped = [verdict for verdict in verdicts if verdict.stops]
    left = LeftOut([verdict.name for verdict in stopped if "package.xml" not in verdict.stops])
    for name, verdict in _by_name(stopped):
        key, why = next(iter(verdict.stops.items()))
        left.lines.append(f"{name} is left out: {key}: {why}")
    print(*left.lines, sep="\n", end="\n" * bool(left.lines), flush=True)
    missing = sorted({name for verdict in verdicts if not verdict.stops
                      for name in verdict.missing if name.endswith("-dev")})
    if missing:
        print(f"Not installed, if the build stops: {' '.join(missing)}; "
              f"rosrun workspace_needs deps {source.resolve().parent}", flush=True)
    chosen = _chosen(args)
    asked = [verdict for verdict in verdicts if not verdict.hides_ours
             and (verdict.name in chosen or not chosen)]
    left.are_all = not ours and bool(asked) and all(verdict.stops for verdict in asked)
    return left


def _chosen(args: list[str]) -> set[str]:
    """The packages that the words name; none: all."""
    names, wanted = set(), False
    for word in args:
        if word.startswith("-"):
            option, _, value = word.partition("=")
            wanted = option in ("--pkg", "--only-pkg-with-deps")
            if wanted and value:
                names.add(value)
            if option.startswith("-DCATKIN_WHITELIST_PACKAGES"):
                names.update(filter(None, value.split(";")))
        elif wanted:
            names.add(word)
    return names


def _by_name(stopped: list[Verdict]) -> list[tuple[str, Verdict]]:
    """The verdicts, with one for all that hide ours, which are mostly one clone."""
    hiding = [verdict for verdict in stopped if verdict.hides_ours]
    named = [(verdict.name, verdict) for verdict in stopped if not verdict.hides_ours]
    if hiding:
        named.insert(0, (", ".join(verdict.name for verdict in hiding), hiding[0]))
    return named


def _run(tool: str, args: list[str], left: LeftOut) -> NoReturn:
    """Runs one of Debian's programs in place of this one, which repeats the lines at its end."""
    command = [f"{FOLDER}/{tool}", *args]
    if not left.lines:
        os.execv(command[0], command)
    # A terminal sends Ctrl-C to both, `kill -INT` only to this one.
    signal.signal(signal.SIGINT, lambda *_: signal.alarm(PATIENCE))
    with subprocess.Popen(command) as process:
        signal.signal(signal.SIGALRM, lambda *_: process.send_signal(signal.SIGINT))
        signal.signal(signal.SIGTERM, lambda *_: process.terminate())
        code = process.wait()
    sys.exit(left.end(code if code >= 0 else 128 - code))


def _become_another_catkin(args: list[str]) -> None:
    """Runs a catkin that this Python cannot import, of pipx or conda; returns if there is none."""
    own = Path(sys.argv[0]).resolve()
    for folder in os.get_exec_path():
        found = shutil.which("catkin", path=folder)
        if found and Path(found).resolve() != own and "workspace_needs" not in _head(found):
            os.execv(found, [found, *args])


def _head(path: str) -> str:
    return Path(path).read_text("utf-8", "replace")[:4000]


def _source(args: list[str]) -> Path:
    """The workspace's source folder, by -C (else the current directory) and --source (else src)."""
    values = dict(itertools.pairwise(args))
    base = Path(values.get("-C") or values.get("--directory") or ".")
    return base / (values.get("--source") or values.get("--source-space") or "src")
