"""Finds and unpacks submissions: a file, folder or archive each, named by student id."""

from __future__ import annotations

import contextlib
import hashlib
import lzma
import os
import shutil
import subprocess
import sys
import tarfile
import tokenize
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path, PurePosixPath
from typing import IO

from run_session.failure import RunError
from run_session.files import check_space


def one_line(text: str) -> str:
    """The text without line ends, terminal codes and undecodable bytes."""
    whole = text.encode("utf-8", "replace").decode()
    return "".join(each if each.isprintable() else " " for each in whole).strip()


def visible(text: str) -> str:
    """Text of several lines in which control and other unprintable characters are shown as codes.
    """
    return "".join(each if each.isprintable() or each in "\n\t" else
                   each.encode("unicode_escape").decode() for each in text)


def file_name(name: str) -> str:
    """A file's name as text; Chinese Windows writes them in GBK."""
    raw = os.fsencode(name)
    for encoding in ("utf-8", "gbk"):
        try:
            return one_line(raw.decode(encoding))
        except UnicodeDecodeError:
            continue
    return one_line(name)


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


def submission_at(path: Path) -> Submission:
    """The submission of one file or folder; RunError if there is none."""
    try:
        whole = path.resolve(strict=True)
    except (OSError, RuntimeError) as error:
        raise RunError(f"--file (FILE=) {path}: "
                       f"{getattr(error, 'strerror', None) or error}") from error
    student, fault = _student(whole)
    return Submission(student, whole, fault)


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
    program = choose_program(folder, patterns)
    name = file_name(str(program))
    _refuse_without_code(folder / program, name)
    if wrong := _in_process(folder / program).stdout.decode(errors="replace"):
        number, _, says = one_line(wrong).partition(" ")
        raise UnpackError(f"exception in {name}, line {number}: {says}")
    return program


def _in_process(*arguments: Path) -> subprocess.CompletedProcess:
    """`main` with these in a process of its own: what it is given can demand any amount of memory
    or time. It prints English: reports are kept in it."""
    command = ["prlimit", f"--as={MOST_MEMORY}", f"--cpu={MOST_TIME}", "--core=0",
               sys.executable, "-PXutf8", "-m", "marking.submissions", *map(str, arguments)]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False,
                          env=os.environ | {"LANGUAGE": "en"})


def _refuse_without_code(program: Path, name: str) -> None:
    """Raise UnpackError for a program without a single line of code."""
    comments = False
    with program.open(encoding="utf-8-sig", errors="replace") as file:
        for line in file:
            text = line.strip()
            if text and not text.startswith("#"):
                return
            comments = comments or bool(text)
    raise UnpackError(f"{name} has only comments" if comments else f"{name} is empty")


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


def _student(entry: os.DirEntry | Path) -> tuple[str, str]:
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


MOST_BYTES = 64 * 2**20  # of all files together, unpacked
MOST_FILES = 2000
MOST_MEMORY, MOST_TIME = 2**30, 20  # bytes, and s of CPU time, for unpacking
TOO_MUCH = "it takes too much memory or time to unpack"
LONGEST_NAME = 200  # bytes of one name in UTF-8; file systems allow 255
UTF8_NAME = 0x800  # bit of a zip entry's flags: its name is UTF-8
ENDINGS = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz")


class UnpackError(Exception):
    """One line on what is wrong with an archive."""


@dataclass(frozen=True)
class _Member:
    """One file of an archive; `open` gives its bytes."""

    name: str
    open: Callable[[], IO[bytes]]


def is_archive(path: Path) -> bool:
    """Whether its name is that of an archive, as course systems export them."""
    return path.name.lower().endswith(ENDINGS)


def archive_stem(name: str) -> str:
    """A file's name without the ending of an archive."""
    ending = max((e for e in ENDINGS if name.lower().endswith(e)), key=len, default="")
    return name[:len(name) - len(ending)]


def unpack(source: Path, folder: Path) -> None:
    """Unpack or copy into a new folder; on UnpackError, and on OSError if the disk is full, the
    folder is removed.
    """
    shutil.rmtree(folder, ignore_errors=True)
    done = _in_process(source, folder)
    if done.returncode:
        try:
            check_space(folder.parent)  # before anything is removed
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        why = done.stdout.decode(errors="replace").strip()
        if not why:  # below 0: a signal
            why = TOO_MUCH if done.returncode < 0 else "the archive cannot be unpacked"
        raise UnpackError(f"{file_name(source.name)}: {why}")


def _unpack(source: Path, folder: Path) -> None:
    """Do the work; UnpackError gives the reason, and may leave an incomplete folder."""
    try:
        if not is_archive(source) or source.is_dir():
            _write(_plain_members(source), folder)
        elif not source.is_file():
            raise UnpackError("is not a file")
        elif source.name.lower().endswith(".zip"):
            with zipfile.ZipFile(source) as opened:
                _write(_zip_members(opened), folder)
        else:
            with tarfile.open(source) as opened:
                _write(_tar_members(opened), folder)
    # zipfile raises NotImplementedError for unknown compression, RuntimeError for a password.
    except (zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, EOFError,
            NotImplementedError, RuntimeError, OSError, ValueError) as error:
        raise UnpackError(f"the archive cannot be unpacked: {error}") from error


def _write(members: Iterator[_Member], folder: Path) -> None:
    left = MOST_BYTES
    for count, member in enumerate(members, start=1):
        if count > MOST_FILES:
            raise UnpackError(f"more than {MOST_FILES} files")
        path = folder / _inside(member.name)
        path.parent.mkdir(parents=True, exist_ok=True)
        with member.open() as source, path.open("xb") as target:
            while block := source.read(min(2**16, left + 1)):
                left -= len(block)
                if left < 0:
                    raise UnpackError(f"more than {MOST_BYTES >> 20} MiB unpacked")
                target.write(block)


def _inside(name: str) -> PurePosixPath:
    """A relative path that stays in the folder; Windows writes backslashes."""
    path = PurePosixPath(name.replace("\\", "/"))
    if path.is_absolute() or ".." in path.parts or not path.parts:
        raise UnpackError(f"{name!r} is a path out of the archive")
    if "\0" in name or any(len(part.encode()) > LONGEST_NAME for part in path.parts):
        raise UnpackError(f"the name {name[:40]!r}... is too long or has a zero byte")
    return path


def _plain_members(source: Path) -> Iterator[_Member]:
    """A single file, or the files of a folder."""
    for path in [source] if source.is_file() else sorted(source.rglob("*")):
        name = path.relative_to(source if source.is_dir() else source.parent)
        if path.is_symlink():
            raise UnpackError(f"{file_name(str(name))} is a symbolic link")
        if path.is_file():
            yield _Member(str(name), lambda path=path: path.open("rb"))


def _zip_members(archive: zipfile.ZipFile) -> Iterator[_Member]:
    for entry in archive.infolist():
        if entry.is_dir():
            continue
        if (entry.external_attr >> 16) & 0o170000 == 0o120000:
            raise UnpackError(f"{entry.filename!r} is a symbolic link")
        yield _Member(_zip_name(entry), lambda entry=entry: archive.open(entry))


def _zip_name(entry: zipfile.ZipInfo) -> str:
    """An entry's name; Chinese Windows writes GBK, which Python reads as code page 437."""
    if entry.flag_bits & UTF8_NAME:
        return entry.filename
    for encoding in ("utf-8", "gbk"):
        try:
            return entry.filename.encode("cp437").decode(encoding)
        except UnicodeError:
            continue
    return entry.filename


def _tar_members(archive: tarfile.TarFile) -> Iterator[_Member]:
    for entry in archive:
        if entry.isdir():
            continue
        if not entry.isreg():
            kind = "a link" if entry.islnk() or entry.issym() else "a device or pipe"
            raise UnpackError(f"{entry.name!r} is {kind}")
        yield _Member(entry.name, lambda entry=entry: archive.extractfile(entry))


NOT_UTF_8 = "the file is not in UTF-8, save it as UTF-8"


def _say_what_does_not_compile(program: Path) -> None:
    """Print a syntax error's line number and text; also of a file that is not in UTF-8."""
    try:
        with tokenize.open(program) as file:
            text = file.read()
    except (SyntaxError, UnicodeDecodeError):  # of a declared encoding, or of the lack of one
        print(f"1 SyntaxError: {NOT_UTF_8}")
        return
    try:
        compile(text, "", "exec")
    except (SyntaxError, ValueError) as error:  # the latter in older releases: a null byte
        line, said = getattr(error, "lineno", 1) or 1, getattr(error, "msg", str(error))
        print(f"{line} SyntaxError: {said}")


def main(source: str, folder: str = "") -> int:
    """Unpack, or without a folder compile; returns the exit code, and prints one line if that
    fails."""
    if not folder:
        _say_what_does_not_compile(Path(source))
        return 0
    os.umask(0o022)  # the sandbox reads it as another user
    Path(folder).mkdir(parents=True)
    try:
        _unpack(Path(source), Path(folder))
    except UnpackError as error:
        print(one_line(str(error)))
        return 1
    except MemoryError:
        print(TOO_MUCH)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
