"""Runs cases on the workers of a Dask cluster; Dask does the scheduling and retries."""

from __future__ import annotations

import argparse
import contextlib
import io
import logging
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from io import BytesIO
from pathlib import Path
from typing import Any
from uuid import uuid4

import dask
from dask.distributed import Client, Future, LocalCluster, Status, Worker, as_completed, get_worker
from distributed.client import ClosedClientError

from evaluation.case_process import ORDER, OUT, RESULT, Order
from evaluation.trial import Case, Trial
from run_session.failure import RunError
from run_session.launch import describe_exit
from run_session.processes import read_log, start_program

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
    process = start_program([sys.executable, "-P", "-m", "evaluation.case_process", folder],
                            {**os.environ, "ROS_HOSTNAME": "localhost"}, log)
    with contextlib.suppress(subprocess.TimeoutExpired):
        while wanted():
            with contextlib.suppress(subprocess.TimeoutExpired):
                return process.wait(LOOK_PERIOD)
        process.send_signal(signal.SIGINT)
        return process.wait(END_TIME)
    process.kill()
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


RETRIES = 1  # of a case that could not be run; Dask counts worker deaths separately
CONNECT_TIME = 10.0  # s, wall
HERE = "127.0.0.1:0"  # of Dask's web pages, any port; without it they are open to the network
ADDRESS = re.compile(r"\w+://[^\s/]+:\d+")


def try_on_workers(trial: Trial, cases: Sequence[Case], options: argparse.Namespace,
                   arguments: Sequence[str], is_needed: Callable[[Case], bool],
                   say: Callable[[str], None]) -> Iterator[tuple[Case, Any]]:
    """Yields cases with their results, as they finish; a CaseError for one that could not be run.

    A case's files are in `options.out` when its result comes. Closing the generator ends all cases.
    """
    dask.config.set({"distributed.worker.profile.enabled": False})  # it costs CPU time
    for name in ("distributed", "distributed.client"):  # the runner reports failures
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with _connected(trial, options) as client:
        if not client.scheduler_info()["workers"]:
            say(f"no workers at {options.scheduler} yet: waiting")

        def ask(asked: Sequence[Case]) -> dict[Future, Case]:
            orders = [pickle.dumps(Order(type(trial), arguments, case, os.getcwd()))
                      for case in asked]
            group = f"{trial.program}-{uuid4()}"  # unique, to get no other run's results
            futures = client.map(
                run_case, orders, out=str(options.out), retries=RETRIES,
                key=[(group, case.name) for case in asked])
            return dict(zip(futures, asked, strict=True))

        waiting = ask(cases)
        finished = as_completed(waiting, loop=client.loop)
        for future in finished:
            case = waiting.pop(future, None)
            if case is None:
                continue
            try:
                outcome = _outcome(future, options.out)
            except CancelledError:  # the connection broke: Dask has reconnected, or gives up
                waiting |= (again := ask([case]))
                finished.update(again)
                continue
            yield case, outcome
            if trial.open_ended:
                for other in [other for other, each in waiting.items() if not is_needed(each)]:
                    del waiting[other]
                    other.cancel()


@contextlib.contextmanager
def _connected(trial: Trial, options: argparse.Namespace) -> Iterator[Client]:
    """A client of the given scheduler, else of a cluster of threads in this process."""
    with contextlib.ExitStack() as opened:
        cluster = options.scheduler or opened.enter_context(LocalCluster(
            n_workers=1, threads_per_worker=options.workers, processes=False,
            dashboard_address=HERE, worker_dashboard_address=HERE))
        client = opened.enter_context(_client_of(cluster))
        try:
            yield client
        except ClosedClientError as error:
            raise RunError(f"scheduler {options.scheduler} is gone; {trial.named('resume')} goes "
                           "on") from error


def _client_of(cluster: str | LocalCluster) -> Client:
    if isinstance(cluster, str) and not ADDRESS.fullmatch(cluster):
        raise RunError(f"SCHEDULER must be such as tcp://192.168.0.10:8786; got {cluster!r}")
    client = Client.__new__(Client)
    try:
        client.__init__(cluster, timeout=CONNECT_TIME, set_as_default=False)
    except (OSError, RuntimeError, TypeError, ValueError) as error:
        client.status = "closed"  # a half-initialised client would try to close for 20 s, and fail
        raise RunError(f"no Dask scheduler at {cluster} (SCHEDULER=): {error}") from None
    return client


def _outcome(future: Future, out: Path) -> Any:
    """Unpack the files; returns the result, or the CaseError."""
    error = future.exception()
    if error is None:
        result, files = future.result()
        unpack(files, out)
        return pickle.loads(result)
    if not isinstance(error, CaseError):  # its workers died, or lack this workspace
        return CaseError(f"{type(error).__name__}: {' '.join(str(error).split())}")
    unpack(error.files, out)
    return error


def unpack(files: bytes, out: Path) -> None:
    """Unpack files below a folder; each one appears atomically."""
    with tempfile.TemporaryDirectory(dir=out, prefix=".case-") as folder:
        with zipfile.ZipFile(BytesIO(files)) as archive:
            archive.extractall(folder)
        shutil.copytree(folder, out, dirs_exist_ok=True, copy_function=os.replace)
