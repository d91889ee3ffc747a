"""Bounds of an expansion: how many parts it may have, and what one process may take for it."""

from __future__ import annotations

import mmap
import os
import resource
import signal
import sys
from collections.abc import Callable
from typing import Any

from xacro.xmlutils import replace_node

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro_errors import one_line, place

MOST_PARTS = 15_000  # macro calls, properties, conditions, blocks; large robots have 3 000
MOST_SECONDS = 3.5  # of processor time; large robots take 1
MOST_BYTES = 2**30
NOTE_BYTES = 1024

_note = mmap.mmap(-1, NOTE_BYTES)  # what is being evaluated; shared with forked processes


class TooLarge(FormatError):
    """An expansion went beyond a bound; another reading of the file will not do better."""


class Budget:
    """Counts what is put into the document, so that macros cannot double without end."""

    def __init__(self) -> None:
        self._left = MOST_PARTS

    def replace_node(self, node: Any, by: Any, content_only: bool = False) -> None:
        """xacro's own, which it calls once for each macro, property, condition, block, include."""
        self._left -= 1
        if self._left < 0:
            raise TooLarge(f"{place('xacro')}: more than {MOST_PARTS} macro calls, properties "
                           "and conditions; do macros call each other without end?")
        replace_node(node, by, content_only)


def noted_eval(evaluate: Callable[..., Any]) -> Callable[..., Any]:
    """The same function, which leaves word of what it is doing."""
    def noted(expression: str, symbols: dict, local: dict | None = None) -> Any:
        said = f"{place('xacro')}: ${{{one_line(expression[:200])}}}".encode()[:NOTE_BYTES]
        _note[:] = said.ljust(NOTE_BYTES, b"\0")
        value = evaluate(expression, symbols, local)
        _note[:1] = b"\0"
        return value

    return noted


def run_bounded(work: Callable[[], int], file: str, seconds: float = MOST_SECONDS) -> int:
    """What `work` returns, as an exit code, from a process of its own that expands `file`.

    Expressions are Python: no bound inside the interpreter ends `10 ** 10 ** 10`. TooLarge says
    what was being evaluated when the processor time ran out.
    """
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            signal.setitimer(signal.ITIMER_VIRTUAL, seconds)  # whose signal ends the process
            resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
            code = work()
            sys.stdout.flush()
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    if os.WIFEXITED(status):
        return os.WEXITSTATUS(status)
    noted = _note[:].rstrip(b"\0").decode(errors="replace")
    where = noted if _note[0] else f"{file}: expanding it"
    if os.WTERMSIG(status) == signal.SIGVTALRM:
        raise TooLarge(f"{where} takes longer than {seconds:g} s of processor time; simplify it")
    raise TooLarge(f"{where} was ended by signal {os.WTERMSIG(status)}")
