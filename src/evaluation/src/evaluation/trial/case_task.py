"""Runs a case on a Dask worker: as a process of its own, in a temporary folder."""

from __future__ import annotations

import io
import os
import select
import signal
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

from dask.distributed import Status, Worker, get_worker

from evaluation.trial.case_process import ORDER, OUT, RESULT
from run_session.failure import RunError
from run_session.launch import describe_exit
from run_session.processes import end_with_parent, read_log

LOOK_PERIOD = 0.5  # s, wall, between two checks whether the case is still wanted
END_TIME = 10.0  # s, wall, for an unwanted case to end; its session takes 3 s at most
DETAILS = 12  # lines
GONE = (Status.closing, Status.closed, Status.failed)


class CaseError(RunError):
    """The case could not be run; `files` holds the files that it left, packed."""

    files: bytes = b""


def run_case(order: bytes, out: str) -> tuple[bytes, bytes]:
    """Returns the pickled result and the packed files; `out` is the folder's name in messages.

    CaseError if the case could not be run. A case whose result is no longer wanted is ended; then,
    and when the worker dies, all of its processes end with it.
    """
    worker = get_worker()
    with tempfile.TemporaryDirectory(dir=worker.local_directory, prefix="case-",
                                     ignore_cleanup_errors=True) as name:
        folder, log = Path(name), Path(name) / "log"
        (folder / ORDER).write_bytes(order)
        code = _run_process(name, log, _wanted_from(worker))
        files = pack(folder / OUT)
        if code == 0:
            return (folder / RESULT).read_bytes(), files
        said = [line.replace(str(folder / OUT), out) for line in read_log(log) if line.strip()]
        reason = said.pop() if code > 0 and said else describe_exit(code)
        error = CaseError(reason.partition(": ")[2] or reason, "\n".join(said[-DETAILS:]))
        error.files = files
        raise error


def _run_process(folder: str, log: Path, wanted: Callable[[], bool]) -> int:
    """Run the case's process; returns its exit code."""
    with log.open("wb") as output:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "evaluation.trial.case_process", folder],
            env={**os.environ, "ROS_HOSTNAME": "localhost"}, stdin=subprocess.DEVNULL,
            stdout=output, stderr=subprocess.STDOUT, start_new_session=True,
            preexec_fn=end_with_parent(os.getpid()))
    ended = os.pidfd_open(process.pid)
    try:
        while not select.select([ended], [], [], LOOK_PERIOD)[0]:
            if not wanted():
                process.send_signal(signal.SIGINT)
                select.select([ended], [], [], END_TIME)
                process.kill()
                break
    finally:
        os.close(ended)
    return process.wait()


def _wanted_from(worker: Worker) -> Callable[[], bool]:
    """A function that tells, by the worker, whether a client still waits for this thread's task."""
    key = worker.get_current_task()

    def wanted() -> bool:
        task = worker.state.tasks.get(key)
        return worker.status not in GONE and task is not None and task.state != "cancelled"

    return wanted


def pack(folder: Path) -> bytes:
    """A zip archive of all files below a folder, which may be missing; without links."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=1,
                         strict_timestamps=False) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file() and not path.is_symlink():
                archive.write(path, path.relative_to(folder))
    return packed.getvalue()
