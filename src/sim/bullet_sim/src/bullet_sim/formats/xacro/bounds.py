"""Limits of an expansion: the number of parts, and the time and memory of its process."""

import gc
import mmap
import os
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import xacro

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.errors import one_line, place
from bullet_sim.formats.xacro.nodes import replace_node

MOST_PARTS = 15_000  # macro calls, properties, conditions, blocks; large robots have 3 000
MOST_TEXTS = 150_000  # attributes and texts evaluated; TurtleBot3 has 110 per link
MOST_SECONDS = 3.5  # of CPU time; large robots take 1
LONG = 1.0  # s; an expression that takes this long is named as the cause
MOST_BYTES = 2**29
NO_MEMORY = 70  # exit code of the process that expands
NOTE_BYTES = 1024
OUT_OF_MEMORY = (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS)  # what libraries in C do then

_note = mmap.mmap(-1, NOTE_BYTES)  # current evaluation and its start; shared with the child


class TooLarge(FormatError):
    """An expansion exceeded a limit; reading the file in another way will not help."""


class Budget:
    """Counts what is added to the document, so that macros cannot grow it without limit."""

    def __init__(self) -> None:
        self._parts = self._texts = 0
        self._eval_text = xacro.eval_text

    def replace_node(self, node: Any, by: Any, content_only: bool = False) -> None:
        """Called by xacro once for each macro, property, condition, block, include.

        TooLarge beyond MOST_PARTS.
        """
        self._parts += 1
        if self._parts > MOST_PARTS:
            raise TooLarge(f"{place('xacro')}: more than {MOST_PARTS} macro calls, properties "
                           "and conditions; do macros call each other without end?")
        replace_node(node, by, content_only)

    def eval_text(self, text: str, symbols: Any) -> Any:
        """Called by xacro once for each attribute and text; most have nothing to evaluate.

        TooLarge beyond MOST_TEXTS.
        """
        self._texts += 1
        if self._texts > MOST_TEXTS:
            raise TooLarge(f"{place('xacro')}: more than {MOST_TEXTS} attributes and texts; do "
                           "macros repeat too much, or is a part in the file too often?")
        return self._eval_text(text, symbols) if "$" in text else text


def noted_eval(evaluate: Callable[..., Any]) -> Callable[..., Any]:
    """The same function, which also records what it evaluates."""
    def noted(expression: str, symbols: dict, local: dict | None = None) -> Any:
        line = f"{time.monotonic()} {place('xacro')}: ${{{one_line(expression[:200])}}}"
        _note[:] = line.encode()[:NOTE_BYTES].ljust(NOTE_BYTES, b"\0")
        value = evaluate(expression, symbols, local)
        _note[:1] = b"\0"
        return value

    return noted


def run_bounded(work: Callable[[], int], file: str, seconds: float = MOST_SECONDS,
                doing: str = "expanding it", most_bytes: int = MOST_BYTES) -> int:
    """The exit code that `work` returns, in a separate process that expands `file`.

    Expressions are Python: no limit inside the interpreter stops `10 ** 10 ** 10`. TooLarge names
    the expression that was evaluated when the CPU time ran out, if that took it.
    """
    sys.stdout.flush()
    _note[:1] = b"\0"
    child = os.fork()
    if child == 0:
        code = 1
        try:
            gc.disable()  # it would traverse the growing document again and again
            signal.signal(signal.SIGPROF, signal.SIG_DFL)  # ends the process
            signal.setitimer(signal.ITIMER_PROF, seconds)
            limit_memory(most_bytes)
            code = work()
            sys.stdout.flush()
        except MemoryError:
            code = NO_MEMORY
        except BrokenPipeError:  # the reader has gone
            pass
        except Exception:
            traceback.print_exc()
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    if os.WIFEXITED(status) and os.WEXITSTATUS(status) != NO_MEMORY:
        return os.WEXITSTATUS(status)
    if os.WIFEXITED(status):
        raise TooLarge(f"{file}: {doing} needs more memory than there is; make it "
                       "smaller")
    where = _what_took(min(LONG, seconds / 2)) or f"{file}: {doing}"
    if os.WTERMSIG(status) == signal.SIGPROF:
        raise TooLarge(f"{where} takes longer than {seconds:g} s of processor time; simplify it")
    if os.WTERMSIG(status) in OUT_OF_MEMORY:
        raise TooLarge(f"{where} needs more memory than there is, or breaks the engine; make it "
                       "smaller")
    raise TooLarge(f"{where} was ended by signal {os.WTERMSIG(status)}")


def limit_memory(most_bytes: int = MOST_BYTES) -> None:
    """Limit this process to so much more than it has from its parent.

    If it is limited already, like check's reader of launch files, it uses what that leaves:
    only root may raise a limit.
    """
    held = int(Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
    most, given = held + most_bytes, resource.getrlimit(resource.RLIMIT_DATA)[1]
    if given != resource.RLIM_INFINITY:
        most = min(most, given)
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def _what_took(long: float) -> str:
    """The expression that has been running, if for at least `long` s."""
    began, _, noted = _note[:].rstrip(b"\0").decode(errors="replace").partition(" ")
    if _note[0] and time.monotonic() - float(began) >= long:
        return noted
    return ""
