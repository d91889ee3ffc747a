"""Runs cases on the workers of a Dask cluster; Dask does the scheduling and retries."""

from __future__ import annotations

import argparse
import contextlib
import logging
import os
import pickle
import re
import shutil
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from io import BytesIO
from pathlib import Path
from typing import Any
from uuid import uuid4

import dask
from dask.distributed import Client, Future, LocalCluster, as_completed
from distributed.client import ClosedClientError

from evaluation.trial.case_process import Order
from evaluation.trial.case_task import CaseError, run_case
from evaluation.trial.protocol import Case, Trial
from run_session.failure import RunError

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
    with _connected(options) as client:
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
def _connected(options: argparse.Namespace) -> Iterator[Client]:
    """A client of the given scheduler, else of a cluster of threads in this process."""
    with contextlib.ExitStack() as opened:
        cluster = options.scheduler or opened.enter_context(LocalCluster(
            n_workers=1, threads_per_worker=options.workers, processes=False,
            dashboard_address=HERE, worker_dashboard_address=HERE))
        client = opened.enter_context(_client_of(cluster))
        try:
            yield client
        except ClosedClientError as error:
            raise RunError(f"scheduler {options.scheduler} is gone; --resume goes on") from error


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
