"""Copies untrusted files and unpacks zip and tar: bounded, and never outside the folder."""

from __future__ import annotations

import lzma
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import IO

from marking.text import file_name, one_line
from run_session.files import check_space

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

    Runs in a process of its own: a header alone can demand any amount of memory or time.
    """
    shutil.rmtree(folder, ignore_errors=True)
    command = ["prlimit", f"--as={MOST_MEMORY}", f"--cpu={MOST_TIME}", "--core=0",
               sys.executable, "-P", "-m", "marking.unpacking", str(source), str(folder)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    if done.returncode:
        try:
            check_space(folder.parent)  # before anything is removed
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        why = done.stdout.decode(errors="replace").strip()
        why = why or (TOO_MUCH if done.returncode < 0 else "cannot be unpacked")  # < 0: a signal
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
        raise UnpackError(f"cannot be unpacked: {error}") from error


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


def main(source: str, folder: str) -> int:
    """Unpack; returns the exit code, and prints one line if that fails."""
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
