"""Runs ruff, and every test by pytest, and ends with one line: N passed, M failed.

Two runs of pytest-xdist go beside each other. One has the files that start processes and mostly
wait for them, rostest files and the pytest files marked `processes`: each in a session of its own,
JOBS at a time. The other has all other files, at low priority: it uses the processors while those
wait. Files that say `runs alone` measure time: they run last, one after the other.

If only a few files that start processes fail, they run once more, alone (of pytest files, just the
failed tests), because a busy machine may starve them. They are then called unsteady; a hang or a
process left running remains a failure.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import run_tests_files as files
import yaml
from run_tests_files import OUT, PYTEST, ROOT, Case

PROCESSES = re.compile(r"^pytestmark = pytest\.mark\.processes\b", re.MULTILINE)
ALONE = re.compile(r"\bruns alone\b")
ANY = re.compile("")
WHOLE = "whole"  # the test that stands for a file with a process of its own
# Messages of pytest and rostest for a test that took too long, and the runner's own.
FINAL = re.compile(r"from pytest-timeout|max time \[[^]]*\] allotted|^(not done|left running)")
GIVE_WAY = ("sh", "-c", '{ echo 5 > /proc/self/autogroup; } 2> /dev/null; exec nice -n 5 "$@"', "")
SESSION_LIMIT = 5400.0  # s for all files of a kind
UNKNOWN = {".py": 120.0, ".test": 20.0}  # s that a file takes of which nothing is kept
MOST_SECOND = 6  # more failed files than this are not chance
MOST_NEW = 3  # unsteady files in one run that test/unsteady.yaml does not name
RUNS = 10  # of this user, in which an unnamed file may be unsteady once
SHOWN = 10
KEPT = (Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
        / "ros1-driving-courses" / "tests.json")
WORKERS = min(max(os.cpu_count() or 2, 2), 8)  # each imports all files without processes
PLAIN = (f"-n{WORKERS}", "--dist=loadfile")
APART = ("--dist=load", "--maxschedchunk=1", "--own-process", "-v")
FAST = ROOT / "test" / "fast.yaml"


@dataclass
class Result:
    """What came of one file of tests, or of one run of pytest."""

    name: str
    cases: list[Case] = field(default_factory=list)
    problems: Sequence[str] = ()  # besides failed tests
    seconds: float = 0.0
    processor: float = 0.0  # s
    first: Result | None = None  # of a run before this one
    output: str = ""  # of a process of its own, if anything failed

    def those(self, outcome: str) -> list[Case]:
        """The cases with this outcome."""
        return [each for each in self.cases if each.outcome == outcome]

    @property
    def failures(self) -> list[str]:
        """A line for each."""
        failed = [each.test for each in self.those("failed")]
        return [f"{self.name}: {each}" for each in (*failed, *self.problems)]


@dataclass
class Kept:
    """What is kept from one run to the next."""

    seconds: dict[str, float] = field(default_factory=dict)  # of each file
    processor: dict[str, float] = field(default_factory=dict)  # s of each file
    unsteady: list[list[str]] = field(default_factory=list)  # files of each of the last runs


def result_of(name: str, problems: Sequence[str], seconds: float) -> Result:
    """The result of a file, or of a run of pytest, that had a process of its own."""
    folder = files.folder_of(name)
    result = Result(name, files.read_cases(folder)[0], problems, seconds)
    if result.failures:
        result.output = (folder / "output.log").read_text(errors="replace")
    return result


def results_of(run: Result) -> list[Result]:
    """The results of each file in a run of pytest, and of that itself."""
    results: dict[str, Result] = {}
    for case in run.cases:
        if case.test == WHOLE:
            own = result_of(case.file, case.problems, case.seconds)
            own.processor = case.processor
            if case.outcome == "failed" and not own.failures:  # its worker has crashed
                own.problems = [case.text]
            results[case.file] = own
        else:
            result = results.setdefault(case.file, Result(case.file))
            result.cases.append(case)
            result.seconds += case.seconds
            result.processor += case.processor
    told = run.problems or any(not each.output for each in results.values() if each.failures)
    return [*results.values(), replace(run, cases=[], output=run.output if told else "")]


def read_kept(path: Path) -> Kept:
    """What is kept in the user's cache; of what cannot be read, nothing."""
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError, AttributeError):
        kept = json.loads(path.read_text("utf-8"))
        seconds, processor = ({name: float(number) for name, number in found.items()}
                              for found in (kept["seconds"], kept.get("processor", {})))
        unsteady = [list(map(str, run)) for run in kept["unsteady"]]
        return Kept(seconds, processor, unsteady[1 - RUNS:])
    return Kept()


def keep(path: Path, kept: Kept) -> None:
    """Write it, unless the home is full or cannot be written."""
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(asdict(kept), indent=1), "utf-8")


def files_that_say(pattern: re.Pattern, glob: str) -> set[Path]:
    """Files below src and test whose text has the pattern."""
    found = [*ROOT.glob(f"src/**/test/**/{glob}"), *ROOT.glob(f"test/**/{glob}")]
    return {path for path in found if pattern.search(path.read_text(encoding="utf-8"))}


def changed_files() -> list[Path]:
    """Files that differ from where this branch left main, and untracked ones."""
    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, text=True, capture_output=True)
        return done.stdout if done.returncode == 0 else ""  # as in an unpacked archive

    bases = (git("merge-base", "HEAD", name).strip() for name in ("origin/main", "main"))
    names = git("diff", "--name-only", next(filter(None, bases), "HEAD"))
    names += git("ls-files", "--others", "--exclude-standard")
    return [ROOT / name for name in names.splitlines()]


def fast_files(changed: list[Path], plain: set[Path]) -> set[Path]:
    """Of files without processes: changed ones, those of changed packages, test/fast.yaml's."""
    homes = {folder / "test" for path in changed for folder in path.parents
             if (folder / "package.xml").exists()}
    listed = yaml.safe_load(FAST.read_text(encoding="utf-8"))
    always = {ROOT / folder / name for folder, names in listed.items() for name in names}
    always.update(changed)
    return {path for path in plain if homes & {*path.parents} or path in always}


def progress() -> Callable[[Path], None]:
    """Shows pytest's lines with a percentage, when they are complete."""
    shown = 0

    def show(log: Path) -> None:
        nonlocal shown
        lines = log.read_text(errors="replace").split("\n")[:-1]
        for line in lines[shown:]:
            if "%]" in line:
                print(f"  {line}", flush=True)
        shown = len(lines)

    return show


def run_pytest(name: str, paths: Sequence[Path], *options: str,
               before: Sequence[str] = ()) -> list[Result]:
    """The results of one run of pytest with these files."""
    if not paths:
        return []
    folder = files.folder_of(name)
    folder.mkdir()
    command = [*before, *PYTEST, f"--junitxml={folder / 'pytest.xml'}", *options,
               *(str(path.relative_to(ROOT)) for path in paths)]
    ended = files.run_marked(command, folder / "output.log", SESSION_LIMIT, progress())
    results = results_of(result_of(name, files.ending(*ended, folder), 0.0))
    lost = {str(path.relative_to(ROOT)) for path in paths} - {each.name for each in results}
    return results + [Result(each, problems=["none of its tests ran"]) for each in sorted(lost)]


def run_alone(path: Path, tests: Iterable[str] = ()) -> Result:
    """The result of a file, or of these tests of it, when nothing else runs."""
    print(f"  alone: {path.relative_to(ROOT)}", flush=True)
    began = time.monotonic()
    used = files.processor_seconds()
    problems = files.run_file(path, tuple(tests))
    result = result_of(str(path.relative_to(ROOT)), problems, time.monotonic() - began)
    return replace(result, processor=files.processor_seconds() - used)


def run_whole(plain: set[Path], apart: set[Path], jobs: int,
              seconds: dict[str, float]) -> list[Result]:
    """Run all these files; of those with processes first the ones that took longest."""
    alone = {path for path in apart if ALONE.search(path.read_text(encoding="utf-8"))}
    beside = sorted(sorted(apart - alone), key=lambda path: -seconds.get(
        str(path.relative_to(ROOT)), UNKNOWN[path.suffix]))
    with ThreadPoolExecutor(2) as pool:
        runs = [pool.submit(run_pytest, "with processes", beside, f"-n{jobs}", *APART),
                pool.submit(run_pytest, "without processes", sorted(plain), *PLAIN,
                            before=GIVE_WAY)]
        results = [each for run in runs for each in run.result()]
    return results + [run_alone(path) for path in sorted(alone) if not files.stopping]


def run_failed_again(results: list[Result], apart: set[Path]) -> list[Result]:
    """The results, with failed files (unless too many) replaced by a second run, alone."""
    if sum(bool(result.failures) for result in results) > MOST_SECOND:
        return results
    return [second_run(result) if may_run_again(result, apart) else result for result in results]


def may_run_again(result: Result, apart: set[Path]) -> bool:
    """Whether it failed, starts processes, and neither hung nor left one of them."""
    said = [*result.problems, *(each.text for each in result.those("failed"))]
    return bool(said) and ROOT / result.name in apart and not any(map(FINAL.search, said))


def second_run(first: Result) -> Result:
    """The file's result when run again, of a Python file just what failed."""
    if files.stopping:
        return first
    folder = files.folder_of(first.name)
    if folder.exists():
        folder.rename(folder.with_name(f"{folder.name}.first"))
    some = first.name.endswith(".py") and not first.problems
    second = run_alone(ROOT / first.name, [each.test for each in first.those("failed")] * some)
    if some:
        second.cases += [each for each in first.cases if each.outcome != "failed"]
    return replace(second, first=first, seconds=first.seconds, processor=first.processor)


def judge_unsteady(results: list[Result], known: list[dict], before: list[list[str]],
                   ) -> tuple[list[str], list[str]]:
    """Show unsteady files; those not known, and failures if these are too many or repeated."""
    unsteady = [result for result in results if result.first and not result.failures]
    names = {each["file"] + (f": {each['test']}" if "test" in each else "") for each in known}
    new = [result.name for result in unsteady
           if result.name not in names and not names.issuperset(result.first.failures)]
    show("Failed beside others, passed alone",
         (line for result in unsteady for line in (*result.first.failures, *reasons(result.first))))
    for name in new:
        print(f"UNSTEADY: {name}: mend it, or name it in test/unsteady.yaml with reason and date")
    if unsteady:
        print(f"{len(unsteady)} unsteady: {' '.join(result.name for result in unsteady)}")
    said = [f"{name}: unsteady twice in {RUNS} runs" for name in new
            if any(name in run for run in before)]
    if len(new) > MOST_NEW:
        said.append(f"{len(new)} unsteady files that test/unsteady.yaml does not name; "
                    f"at most {MOST_NEW}")
    return new, said


def reasons(result: Result) -> list[str]:
    """The first line of what each failed case says, as pytest marks it."""
    return [f"  {found[0]}" for each in result.those("failed")
            if (found := re.findall(r"^E +.+", each.text, re.MULTILINE))]


def show(title: str, lines: Iterable[str]) -> None:
    """Print a list under its title, if there are any."""
    if lines := list(lines):
        print(f"\n{title}:", *lines, sep="\n  ", flush=True)


def show_outputs(results: list[Result]) -> None:
    """Print the output of failed files, from the first run and the last."""
    for result in results:
        for title, run in ((f"{result.name}, first run", result.first), (result.name, result)):
            if run and run.output:
                print(f"\n==== {title}", *run.output.splitlines(), sep="\n  | ")


def show_seconds(seconds: dict[str, float], processor: dict[str, float], kept: Kept) -> None:
    """The files that took longest and most of the processors, and those that grew most since."""
    def grown(now: dict[str, float], before: dict[str, float]) -> dict[str, float]:
        return {name: now[name] - before[name] for name in now if now[name] > before.get(name, 1e9)}

    for title, found, form in (
            ("Slowest", seconds, "7.1f"),
            ("Grew most", grown(seconds, kept.seconds), "+7.1f"),
            (f"Most of {sum(processor.values()):.0f} processor seconds", processor, "7.1f"),
            ("Processor seconds that grew most", grown(processor, kept.processor), "+7.1f")):
        longest = sorted(found, key=found.get, reverse=True)[:SHOWN]
        show(title, (f"{found[name]:{form}} s  {name}" for name in longest))


def show_totals(results: list[Result]) -> bool:
    """Print why tests were skipped, what failed, and the last line; whether something passed and
    nothing failed."""
    skipped = Counter(" ".join(each.text.split()) or "no reason given"
                      for result in results for each in result.those("skipped"))
    show("Skipped", (f"{count:5d}  {reason}" for reason, count in skipped.most_common()))
    failures = [failure for result in results for failure in result.failures]
    show("Failed", failures)
    passed = sum(len(result.those("passed")) for result in results)
    last = f"{passed} passed, {len(failures)} failed"
    print(last + (f", {skipped.total()} skipped" if skipped else ""), flush=True)
    return bool(passed) and not failures


def stop(_signal: int, _frame: object) -> None:
    """Handler of the signals that end the run."""
    files.stopping = True


def main() -> int:
    """Run all; 0 if something passed and nothing failed, 130 if interrupted."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=3, help="files with processes at a time (3)")
    parser.add_argument("--fast", action="store_true", help="those of changed packages and the "
                        "core, without processes")
    parser.add_argument("files", nargs="*", type=Path, help="only these")
    args = parser.parse_args()
    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(name, stop)
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    kept = read_kept(KEPT)
    apart = files_that_say(PROCESSES, "test_*.py") | files_that_say(ANY, "*.test")
    plain = files_that_say(ANY, "test_*.py") - apart - files.rostest_scripts()
    if args.files:
        named = {path.resolve() for path in args.files}
        if strange := named - plain - apart:
            parser.error(f"{min(strange)}: no file of tests; they are test_*.py and *.test in the "
                         "folders test")
        plain, apart = plain & named, apart & named
    if args.fast:
        chosen = fast_files(changed_files(), plain)
        results = run_pytest("fast", sorted(chosen), *PLAIN)
        print(f"FAST=1 left out {len(plain | apart) - len(chosen)} of {len(plain | apart)} files")
    else:
        results = run_whole(plain, apart, args.jobs, kept.seconds)
    results = run_failed_again(results, apart)
    if files.stopping:
        print("interrupted: nothing of it runs any more", file=sys.stderr)
        return 130
    show_outputs(results)
    of_files = [result for result in results if "." in result.name]
    seconds = {result.name: round(result.seconds, 1) for result in of_files}
    processor = {result.name: round(result.processor, 1) for result in of_files}
    show_seconds(seconds, processor, kept)
    if not args.fast:  # which has no file that could be unsteady, and is none of the ten runs
        print("\n==== conformance", flush=True)
        subprocess.run([sys.executable, ROOT / "scripts" / "conformance.py"])
        known = yaml.safe_load((ROOT / "test" / "unsteady.yaml").read_text(encoding="utf-8"))
        new, problems = judge_unsteady(results, known or [], kept.unsteady)
        results.append(Result("unsteady files", problems=problems))
        kept.unsteady.append(new)
    kept.seconds |= seconds
    kept.processor |= processor
    keep(KEPT, kept)
    return 0 if show_totals(results) else 1


if __name__ == "__main__":
    sys.exit(main())
