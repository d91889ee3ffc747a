"""A case in a process of its own: `python3 -m evaluation.case_process FOLDER`.

FOLDER/case is a pickled Order; the process leaves FOLDER/result, pickled, and FOLDER/out. It
writes to standard output; if there is no result, its last line gives the reason.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from evaluation.command_line import PASSED, run_program
from evaluation.trial import Case, Trial
from run_session.session import Session

ORDER, RESULT, OUT = "case", "result", "out"


@dataclass(frozen=True)
class Order:
    """All that another machine needs of a case besides its own evaluation package."""

    trial: type[Trial]
    arguments: Sequence[str]
    case: Case
    start: str  # the folder to which paths among the arguments are relative


def _run(order: Order, folder: Path) -> int:
    with contextlib.suppress(OSError):  # another machine may lack this folder
        os.chdir(order.start)
    trial = order.trial()
    options = trial.parse([*order.arguments, "--out", str(folder / OUT)])
    options.out.mkdir()
    with Session(options.out) as session:
        result = trial.judge(trial.drive(session, order.case))
    (folder / RESULT).write_bytes(pickle.dumps(result))
    return PASSED


if __name__ == "__main__":
    FOLDER = Path(sys.argv[1])
    ORDERED = pickle.loads((FOLDER / ORDER).read_bytes())
    sys.exit(run_program(ORDERED.trial.program, lambda: _run(ORDERED, FOLDER)))
