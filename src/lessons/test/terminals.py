"""Terminals in which commands are typed, as a learner has them open side by side."""

from __future__ import annotations

import codecs
import contextlib
import fcntl
import os
import pty
import random
import re
import signal
import socket
import subprocess
import sys
import termios
import threading
import time
from pathlib import Path

LIMIT = 60.0  # s, for whatever is waited for
POLL = 0.05  # s
IMPATIENCE = 4.0  # s until Ctrl-C is typed again
# A terminal's shell stays when a command has ended, and with it what the command has left behind:
# without it Linux hangs up on that. `rosbag record` ends before its recorder has closed the bag.
SHELL = """
import ctypes, os, signal, subprocess, sys
PR_SET_CHILD_SUBREAPER = 36
ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)  # what is left behind is its child
signal.signal(signal.SIGINT, lambda *_: None)
code = subprocess.call(["bash", "-c", sys.argv[1]])
try:
    while True:
        os.wait()
except ChildProcessError:
    sys.exit(code if code >= 0 else 128 - code)
"""
COLOUR = re.compile(r"\x1b\[[0-9;]*m|\x1b\]2;[^\x07]*\x07|\r")
CUT_OFF = re.compile(r"\x1b(\[[0-9;]*|\](2(;[^\x07]*)?)?)?$")  # the beginning of a COLOUR


def free_port() -> int:
    """None that Linux gives to a socket which asks for any, before a roscore has taken it."""
    while True:
        port = random.randrange(20000, 32768)
        with socket.socket() as probe, contextlib.suppress(OSError):  # it is in use
            probe.bind(("localhost", port))
            return port


def _take_terminal() -> None:
    """Makes stdin the terminal of the new session, so that a typed Ctrl-C interrupts it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class Terminal:
    """One command in a terminal of its own, and what it has shown so far."""

    def __init__(self, command: str, folder: Path, environment: dict[str, str]):
        self.command, self.shown = command, ""
        self._keyboard, screen = pty.openpty()
        self._process = subprocess.Popen(
            [sys.executable, "-ISc", SHELL, command], cwd=folder, env=environment, stdin=screen,
            stdout=screen, stderr=screen, start_new_session=True, preexec_fn=_take_terminal)
        os.close(screen)
        # Reads all the time, as a terminal does: a command blocks once 4 kB wait to be read.
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def type(self, keys: str) -> None:
        os.write(self._keyboard, keys.encode())

    def _read(self) -> None:
        """Adds what the command writes, until the other end is closed."""
        decoder, rest = codecs.getincrementaldecoder("utf-8")(errors="replace"), ""
        # Linux makes an error of it when the last process of the terminal has ended.
        with contextlib.suppress(OSError):
            while data := os.read(self._keyboard, 65536):
                text = rest + decoder.decode(data)
                cut = CUT_OFF.search(text)
                text, rest = (text[:cut.start()], cut[0]) if cut else (text, "")
                self.shown += COLOUR.sub("", text)

    def wait_until_shown(self, pattern: str, limit: float = LIMIT) -> str | None:
        """What is wrong, or None once the pattern has been shown."""
        end = time.monotonic() + limit
        while (not re.search(pattern, self.shown) and self._reader.is_alive()
               and time.monotonic() < end):
            self._reader.join(POLL)
        if re.search(pattern, self.shown):
            return None
        return f"`{self.command}` never showed /{pattern}/, but:\n{self.shown[-3000:]}"

    def wait_until_ended(self, code: int, limit: float = LIMIT) -> str | None:
        """What is wrong, or None once it has ended with this exit code."""
        end = time.monotonic() + limit
        while self._process.poll() is None and time.monotonic() < end:
            time.sleep(POLL)
        if self._process.poll() == code:
            return None
        return f"`{self.command}` ended with {self._process.poll()}:\n{self.shown[-3000:]}"

    def _lives(self) -> bool:
        """The command, or what it has started."""
        self._process.poll()
        try:
            os.killpg(self._process.pid, 0)
        except ProcessLookupError:
            return False
        return True

    def close(self, limit: float = 20.0) -> None:
        """Ctrl-C, and what does not mind it is killed; nothing of its group is left."""
        # Nobody is quicker; a signal that meets rospy in the midst of a log line blocks it.
        time.sleep(0.4)
        end = time.monotonic() + limit
        typed_at = float("-inf")
        while self._lives() and time.monotonic() < end:
            # As a person does: roslaunch may overlook the first while it starts its nodes.
            if time.monotonic() - typed_at >= IMPATIENCE and self._process.poll() is None:
                self.type("\x03")
                typed_at = time.monotonic()
            time.sleep(POLL)
        if self._lives():
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._reader.join(IMPATIENCE)
        if not self._reader.is_alive():  # else the number might be another's when it reads again
            os.close(self._keyboard)
