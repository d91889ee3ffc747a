"""Runs a target on inputs in a process of its own, with bounds on time and memory."""

from __future__ import annotations

import faulthandler
import json
import logging
import os
import resource
import select
import shutil
import signal
import sys
import tempfile
import time
import traceback
from pathlib import Path

from target import THIS_FILE, Target

LIMIT = 2.0  # s of processor time for an input: other work on the machine counts nothing
LONGEST_WAIT = 30.0  # s, wall; then it waits for something that never comes
MEMORY = 1 << 30  # bytes on top of what the process has at its start
INPUTS = 200  # of one process: caches of readers fill its memory, which is no finding
LONGEST_LINE = 2000  # characters
TICKS = os.sysconf("SC_CLK_TCK")


class Sandbox:
    """A process that is begun again when it has died, and after many inputs."""

    def __init__(self, target: Target) -> None:
        self._target = target
        self._folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
        for path in target.beside:
            (self._folder / path.name).symlink_to(path)
        self._file = self._folder / target.file
        self._child = 0

    def fault(self, content: bytes) -> str | None:
        """What is wrong with how it takes this input, in one line; None if nothing is."""
        found = self._run(content)
        if found:  # by itself: not what the inputs before left behind
            self.close_process()
            found = self._run(content)
        return found

    def close(self) -> None:
        """End the process, remove the folder."""
        self.close_process()
        shutil.rmtree(self._folder, ignore_errors=True)

    def close_process(self) -> None:
        if self._child:
            os.kill(self._child, signal.SIGKILL)
            self._forget()

    def _run(self, content: bytes) -> str | None:
        if not self._child or self._left == 0:
            self.close_process()
            self._start()
        self._left -= 1
        self._file.write_bytes(content.replace(THIS_FILE, os.fsencode(self._file)))
        began, spent = time.monotonic(), self._spent()
        os.write(self._asks, b"\n")
        while not select.select([self._answers], [], [], 0.1)[0]:
            if self._spent() - spent > 2 * LIMIT or time.monotonic() - began > LONGEST_WAIT:
                self.close_process()
                return f"hangs: more than {LIMIT:g} s"
        answer = os.read(self._answers, 1 << 16)
        if not answer:
            return self._death()
        return json.loads(answer)

    def _start(self) -> None:
        asked, self._asks = os.pipe()
        self._answers, answer = os.pipe()
        sys.stdout.flush()
        self._child, self._left = os.fork(), INPUTS
        if self._child == 0:
            os.close(self._asks)
            os.close(self._answers)
            _serve(self._target, self._file, asked, answer)
        os.close(asked)
        os.close(answer)

    def _forget(self) -> int:
        _, status = os.waitpid(self._child, 0)
        os.close(self._asks)
        os.close(self._answers)
        self._child = 0
        return status

    def _death(self) -> str:
        code = os.waitstatus_to_exitcode(self._forget())
        name = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        return f"crashes: {name}"

    def _spent(self) -> float:
        """Processor time so far, s."""
        words = Path(f"/proc/{self._child}/stat").read_text().rpartition(")")[2].split()
        return (int(words[11]) + int(words[12])) / TICKS


class _Lines(logging.Handler):
    """Looks at what a reader logs: lines, without tracebacks."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.wrong: str | None = None

    def emit(self, record: logging.LogRecord) -> None:
        if record.exc_info:
            self.wrong = f"logs a traceback: {_one_line(record.getMessage())}"
        elif not _is_line(text := record.getMessage()):
            self.wrong = f"logs more than a line: {_one_line(text)}"


def _serve(target: Target, file: Path, asked: int, answer: int) -> None:
    """In the child: an answer for each question; never returns."""
    faulthandler.disable()  # pytest's would fill the log with what is asked for here
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        lines = _Lines()
        logging.getLogger().handlers[:] = [lines]
        os.chdir(file.parent)
        held = int(Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_DATA, (held + MEMORY, held + MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        while os.read(asked, 1):
            lines.wrong = None
            began = time.process_time()
            told = _try(target, file) or lines.wrong
            spent = time.process_time() - began
            if not told and spent > LIMIT:
                told = f"hangs: more than {LIMIT:g} s"
            os.write(answer, json.dumps(told).encode())
    finally:
        os._exit(3)


def _try(target: Target, file: Path) -> str | None:
    try:
        target.read(file)
    except target.refusals as error:
        if not str(error).strip():
            return f"{type(error).__name__} without a word"
        if not _is_line(str(error)):
            return f"{type(error).__name__} of more than a line: {_one_line(str(error))}"
    except BaseException as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        ours = [frame for frame in traceback.extract_tb(error.__traceback__)
                if "/src/" in frame.filename]
        where = ours[-1] if ours else where
        return (f"{type(error).__name__} at {Path(where.filename).name}:{where.lineno}: "
                f"{_one_line(str(error))}")
    return None


def _is_line(text: str) -> bool:
    return "\n" not in text.strip() and len(text) <= LONGEST_LINE


def _one_line(text: str) -> str:
    return " ".join(text.split())[:200]
