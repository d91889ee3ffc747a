"""How programs end at Ctrl-C, SIGTERM (roslaunch, kill) and SIGHUP (a closed terminal).

And what they leave of a terminal whose keys they have read.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import termios
import threading
import tty
from collections.abc import Callable, Iterator

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:  # by nohup: it goes on without its terminal
    SIGNALS = SIGNALS[:2]


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """The first of these signals raises KeyboardInterrupt; later ones do not disturb the cleanup.

    Used again within it, the inner block can be interrupted once more. After a block that ends by
    itself they do what they did before it. For a program that does one thing after another.
    """
    before = {number: signal.getsignal(number) for number in SIGNALS}

    def interrupt(_number: int, _frame: object) -> None:
        for number in SIGNALS:  # not SIG_IGN: Python writes a traceback if one has just come
            signal.signal(number, lambda *_: None)
        raise KeyboardInterrupt

    for number in SIGNALS:
        signal.signal(number, interrupt)
    yield
    for number in SIGNALS:
        signal.signal(number, before[number])


def drop_unread_output() -> bool:
    """Whether the reader of the output, as of `roslaunch ... | grep`, has ended: what is printed
    from now on then goes nowhere, so that no line ends the cleanup.
    """
    outputs = select.poll()
    for number in (1, 2):
        outputs.register(number, 0)
    unread = [number for number, event in outputs.poll(0) if event & select.POLLERR]
    for number in unread:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, number)
        os.close(nowhere)
    return bool(unread)


@contextlib.contextmanager
def single_keys(terminal: int) -> Iterator[None]:
    """Each key at once and unseen; whatever happens, the terminal is as before afterwards."""
    before = termios.tcgetattr(terminal)
    try:
        tty.setcbreak(terminal)
        yield
    finally:
        with contextlib.suppress(termios.error):  # it may be closed: nothing is to be put back
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def at_signals(ask: Callable[[], None], limit: float, force: Callable[[int], object],
               numbers: tuple[int, ...] = SIGNALS) -> None:
    """At each of these signals, call `ask`, and after `limit` s (wall) `force` with the exit code.

    For a loop that must not be interrupted anywhere, with locks held: `ask` tells it to end soon.
    Either may be stuck, for example with a master that is gone: `force` runs on a thread of its
    own.
    """

    def end(number: int, _frame: object) -> None:
        last = threading.Timer(limit, force, (128 + number,))
        last.daemon = True
        last.start()
        ask()

    for number in numbers:
        signal.signal(number, end)
