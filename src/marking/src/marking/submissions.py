"""Finds the submissions in a folder: a file, folder or archive each, named by student id."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

from marking.text import file_name
from marking.unpacking import MOST_BYTES, UnpackError, archive_stem, is_archive, unpack
from run_session.failure import RunError

NO_PROGRAMS = ("__init__.py", "setup.py", "conftest.py", "test_*.py", "*_test.py")


@dataclass(frozen=True)
class Submission:
    """One student's submission; `fault` says in one line why it cannot be run."""

    student: str
    source: Path  # the file or folder as handed in
    fault: str = ""


def find_submissions(folder: Path) -> list[Submission]:
    """All submissions, sorted by name; RunError if there are none."""
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError as error:
        raise RunError(f"--submissions (SUBMISSIONS=) {folder}: {error.strerror}") from error
    found: dict[str, Submission] = {}
    for entry in entries:
        if entry.name.startswith("."):
            continue
        student, fault = _student(entry)
        if earlier := found.get(student):
            named = " and ".join(file_name(name) for name in (earlier.source.name, entry.name))
            fault = f"{named} are both {student}'s"
        found[student] = Submission(student, Path(entry.path), fault)
    if not found:
        raise RunError(f"--submissions (SUBMISSIONS=) {folder}: there is nothing in it")
    return list(found.values())


def digest(source: Path) -> str:
    """SHA-256 over the names and contents of a submission's files; of links it takes the target,
    of files too large to unpack the size and modification time."""
    sums, left = hashlib.sha256(), MOST_BYTES
    paths = [] if source.is_symlink() else sorted(source.rglob("*"))
    for path in [source, *paths]:
        sums.update(os.fsencode(path.relative_to(source)) + b"\0")
        with contextlib.suppress(OSError):  # unreadable files are reported when unpacking
            if path.is_symlink():
                sums.update(os.fsencode(os.readlink(path)))
            elif path.is_file():
                there = path.stat()
                left -= there.st_size
                if left < 0:
                    sums.update(f"{there.st_size} {there.st_mtime_ns}".encode())
                else:
                    with path.open("rb") as file:
                        sums.update(hashlib.file_digest(file, "sha256").digest())
    return sums.hexdigest()


def prepare(submission: Submission, folder: Path, patterns: Sequence[str]) -> Path:
    """Copy or unpack it into a new folder; returns its program there. Raises UnpackError."""
    if submission.fault:
        raise UnpackError(submission.fault)
    unpack(submission.source, folder)
    return choose_program(folder, patterns)


def choose_program(folder: Path, patterns: Sequence[str]) -> Path:
    """The only Python file, else the only match of the first pattern that matches any."""
    files = [path.relative_to(folder) for path in sorted(folder.rglob("*.py"))
             if path.is_file() and not any(fnmatch(path.name, each) for each in NO_PROGRAMS)
             and "__MACOSX" not in path.parts]
    for pattern in ("*", *patterns) if len(files) == 1 else patterns:
        fitting = [path for path in files if fnmatch(path.name, pattern)]
        if len(fitting) == 1:
            return fitting[0]
        if fitting:
            break
    if not files:
        raise UnpackError("there is no Python program in it (a file NAME.py)")
    named = ", ".join([*(file_name(str(path)) for path in files[:5]),
                       *(["..."] if len(files) > 5 else [])])
    raise UnpackError(f"which program drives? There are {named}; hand in one, or name one of "
                      f"them {patterns[0]}")


def _student(entry: os.DirEntry) -> tuple[str, str]:
    """The student's id, and a fault in the entry or ""."""
    name = file_name(entry.name)
    stem = archive_stem(name)
    student = stem.removesuffix(".py") if stem == name else stem
    if not student.strip("."):
        student = name  # it also names a folder
    if entry.is_symlink():
        return student, f"{name} is a symbolic link"
    if entry.is_dir() or is_archive(Path(name)) or name.endswith(".py"):
        return student, ""
    return name, f"{name} is not a Python file, a folder, a zip or a tar"
