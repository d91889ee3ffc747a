"""A lock that one run at a time holds while it chooses a free port and starts listening there."""

from __future__ import annotations

import fcntl
import os
import time
from pathlib import Path
from typing import IO

from run_session.failure import RunError

LIMIT = 300.0  # s, wall; as long as a roscore may take
PERIOD = 0.05  # s, wall, between two attempts


def take_turn(path: Path, limit: float = LIMIT) -> IO:
    """Lock the file and return it: closing it releases the lock.

    RunError if it is not released within `limit`, s, wall, or if it is another user's.
    """
    try:
        number = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}: name a folder of your own for temporary files,"
                       " such as: export TMPDIR=~/tmp") from error
    file = os.fdopen(number, "r+b")
    until = time.monotonic() + limit
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return file
        except BlockingIOError:
            if time.monotonic() > until:
                file.close()
                raise RunError(f"{path} is held by another run that starts its roscore for more"
                               f" than {limit:.0f} s: end it, then run this again") from None
            time.sleep(PERIOD)
