"""`rosdep` as tutorials type it: Debian's, on our files, without init, update and network."""

from __future__ import annotations

import itertools
import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import rospkg

from workspace_needs import apt, cache
from workspace_needs.tables import ABSENT, DEBIAN, OURS, Tables
from workspace_needs.workspace import WorkspaceError, read_workspace

COMMANDS = ("check", "db", "fix-permissions", "init", "install", "keys", "resolve", "update",
            "what-needs", "where-defined")
WITH_VALUES = ("--rosdistro", "--os", "--filter-for-installers", "--sources-cache-dir", "-c")
OF_A_WORKSPACE = ("install", "check")
SUCCESS = ("#All required rosdeps installed successfully",  # rosdep's own lines
           "All system dependencies have been satisfied")
LIBRARY = Path(sys.prefix) / "rosdep"  # a folder of its own: see dependencies/packages.yaml


def main(argv: list[str] | None = None) -> int:
    """rosdep's exit code; 1 if a key is unknown, which is reported after the rest was installed."""
    args = list(sys.argv[1:] if argv is None else argv)
    sys.path.append(str(LIBRARY))
    try:
        from rosdep2.main import rosdep_main
    except ImportError as error:
        print(f"rosdep: {error}: make setup installs it", file=sys.stderr)
        return 1
    if os.environ.get("ROSDEP_SOURCE_PATH"):  # the user has own sources: plain rosdep
        return _code(rosdep_main, args)
    command = next((word for word in args if word in COMMANDS), "")
    if command == "init":
        print("rosdep: no init is needed, its sources are part of this workspace")
        return 0
    try:
        cache.enter()
    except OSError as error:
        print(f"rosdep: its cache cannot be written: {error}", file=sys.stderr)
        return 1
    tables = Tables()
    if command == "update":
        print(f"rosdep: its {len(tables.debian) + len(tables.ours)} keys are part of this "
              "workspace and up to date; no network is needed")
        return 0
    _follow_distro(args)
    try:
        for folder in _from_paths(args, command):
            read_workspace(folder)
    except WorkspaceError as error:  # rosdep ends with a traceback
        print(f"rosdep: {error}", file=sys.stderr)
        return 1
    if command in OF_A_WORKSPACE:
        return _of_a_workspace(rosdep_main, args, command, tables)
    if command == "resolve":
        return _resolve(rosdep_main, args, tables)
    return _code(rosdep_main, args)


def _resolve(rosdep_main: Callable, args: list[str], tables: Tables) -> int:
    """resolve: a line for each key that nobody has, or only another release."""
    answers = {key: tables.answer(key) for before, key in itertools.pairwise(args)
               if key[:1] not in ("-", "") and key != "resolve" and before not in WITH_VALUES}
    lacking = [key for key, answer in answers.items() if answer.kind not in (OURS, DEBIAN)]
    # rosdep would print its table's row of ten lines
    known = [key for key in lacking if key in tables.debian]
    code = 0 if known and len(known) == len(answers) else _code(
        rosdep_main, [word for word in args if word not in known])
    for key in lacking:
        print(f"rosdep: {key}: {answers[key].why}", file=sys.stderr)
    return code or int(bool(lacking))


def _code(rosdep_main: Callable, args: list[str]) -> int:
    try:
        return rosdep_main(args) or 0
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)


def _follow_distro(args: list[str]) -> None:
    """Sets ROS_DISTRO as --rosdistro says, so that rosdep does not warn of a difference."""
    for word, value in zip(args, [*args[1:], ""]):
        if word.startswith("--rosdistro"):
            os.environ["ROS_DISTRO"] = word.partition("=")[2] or value


def _from_paths(args: list[str], command: str) -> list[Path]:
    """The folders in the arguments, if there is --from-paths."""
    if not any(word.startswith("--from-path") for word in args):
        return []
    words = [word for word in args if word[:1] != "-"]
    words.remove(command)  # a workspace has a folder called install
    return [Path(word) for word in words if Path(word).is_dir()]


def _of_a_workspace(rosdep_main: Callable, args: list[str], command: str, tables: Tables) -> int:
    """install or check: keys that nobody has stop nothing, and are reported at the end."""
    simulate = bool({"-s", "--simulate"} & set(args))
    watch = Watch(tables)
    watch.patch(simulate)
    code = _code(rosdep_main, [*args, "-n"])  # apt resolves Debian's own dependencies
    absent, unknown = watch.told()
    for line in absent + unknown:
        print(line, file=sys.stderr)
    if watch.failure:
        print(f"rosdep: {watch.failure}", file=sys.stderr)
    return code or int(bool(unknown) and "-r" not in args)


class Watch:
    """Intercepts rosdep's lookups, and records the keys that nobody has."""

    def __init__(self, tables: Tables):
        self._tables = tables
        self._askers: dict[str, set[str]] = {}  # by key, the packages that depend on it
        self._not_had: list[str] = []
        self.failure = ""

    def patch(self, simulate: bool) -> None:
        """Patch rosdep for the rest of this process."""
        from rosdep2 import installers, lookup, main
        from rosdep2.platforms import debian

        view_lookup, get_rosdeps = lookup.RosdepView.lookup, lookup.RosdepLookup.get_rosdeps

        def look_up(view, key: str):
            try:
                found = view_lookup(view, key)
            except KeyError:
                found = None
            if found is None or self._tables.answer(key).kind == ABSENT:
                return lookup.RosdepDefinition(key, {"debian": list(self._other(key))})
            return found

        def ask(lookups, resource: str, implicit: bool = True):
            keys = get_rosdeps(lookups, resource, implicit=implicit)
            for key in set(keys) - set(lookups.skipped_keys):
                self._askers.setdefault(key, set()).add(resource)
            return keys

        def one_command(installer, resolved, interactive=True, reinstall=False, quiet=False):
            wanted = installer.get_packages_to_install(resolved, reinstall=reinstall)
            yes = [] if interactive else ["-y"]
            return [installer.elevate_priv(["apt-get", "install", *yes, *wanted])] if wanted else []

        def say(*words, **options):
            if not (words[:1] and words[0] in SUCCESS and any(self.told())):
                print(*words, **options)

        main.print = say
        lookup.RosdepView.lookup = look_up
        lookup.RosdepLookup.get_rosdeps = ask
        debian.AptInstaller.get_install_command = one_command
        if not simulate:
            installers.subprocess = SimpleNamespace(call=self._install)

    def _install(self, command: list[str]) -> int:
        """Replaces rosdep's installer for the command that `one_command` made."""
        words = command[command.index("install") + 1:]
        if "-y" not in words:
            print(f"Install {len(words)} Debian packages ({' '.join(words)})? [Y/n] ", end="")
            answer = (sys.stdin.readline() or "n").strip().lower()  # end of input: no
            if answer not in ("", "y", "yes"):
                self.failure = "nothing was installed; -y installs without a question"
                return 1
        try:
            apt.install([word for word in words if word != "-y"])
        except apt.AptError as error:
            self.failure = str(error)
            return 1
        return 0

    def _other(self, key: str) -> tuple[str, ...]:
        """Packages for a key that is not in rosdep's files; none if nobody has it."""
        answer = self._tables.answer(key)
        if answer.kind not in (OURS, DEBIAN):
            self._not_had.append(key)
        return answer.packages

    def told(self) -> tuple[list[str], list[str]]:
        """A line for each key that nobody has: the known ones (absent.yaml), and the others.

        Ignores keys that only Debian's packages depend on: apt handles those.
        """
        absent, unknown = [], []
        here = set(rospkg.RosPack().list())  # now includes the folders of --from-paths
        for key in sorted(set(self._not_had) & set(self._askers) - here):
            answer = self._tables.answer(key)
            askers = ", ".join(sorted(self._askers[key]))
            line = f"rosdep: {key} (dependency of {askers}): {answer.why}"
            (absent if answer.kind == ABSENT else unknown).append(line)
        return absent, unknown
