"""Hands cases to the workers of a Dask cluster. Whose turn it is, and another try, are Dask's."""

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

RETRIES = 1  # of a case that could not be run; workers that die with it are counted by Dask
CONNECT_TIME = 10.0  # s, wall
ADDRESS = re.compile(r"\w+://[^\s/]+:\d+")


def try_on_workers(trial: Trial, cases: Sequence[Case], options: argparse.Namespace,
                   arguments: Sequence[str], is_needed: Callable[[Case], bool],
                   say: Callable[[str], None]) -> Iterator[tuple[Case, Any]]:
    """Cases and their results, as they come; a CaseError instead of one that could not be had.

    A case's files are in `options.out` when its result comes. Ending the generator ends what runs.
    """
    dask.config.set({"distributed.worker.profile.enabled": False})  # it costs processor time
    for name in ("distributed", "distributed.client"):  # failures are the runner's to tell
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with _connected(options) as client:
        if not client.scheduler_info()["workers"]:
            say(f"no workers at {options.scheduler} yet: waiting")

        def ask(asked: Sequence[Case]) -> dict[Future, Case]:
            orders = [pickle.dumps(Order(type(trial), arguments, case, os.getcwd()))
                      for case in asked]
            group = f"{trial.program}-{uuid4()}"  # a key each, so that no other run's is taken
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
            except CancelledError:  # the connection broke: Dask has made it anew, or gives up
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
    """A client of the scheduler that was named, else of threads of this process."""
    with contextlib.ExitStack() as opened:
        cluster = options.scheduler or opened.enter_context(LocalCluster(
            n_workers=1, threads_per_worker=options.workers, processes=False,
            dashboard_address=None))
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
        client.status = "closed"  # half a client would try for 20 s to close, and end badly
        raise RunError(f"no Dask scheduler at {cluster} (SCHEDULER=): {error}") from None
    return client


def _outcome(future: Future, out: Path) -> Any:
    """The result, or the CaseError; the files are unpacked."""
    error = future.exception()
    if error is None:
        result, files = future.result()
        unpack(files, out)
        return pickle.loads(result)
    if not isinstance(error, CaseError):  # its workers died, or know nothing of this workspace
        return CaseError(f"{type(error).__name__}: {' '.join(str(error).split())}")
    unpack(error.files, out)
    return error


def unpack(files: bytes, out: Path) -> None:
    """Put packed files below a folder; each of them appears whole."""
    with tempfile.TemporaryDirectory(dir=out, prefix=".case-") as folder:
        with zipfile.ZipFile(BytesIO(files)) as archive:
            archive.extractall(folder)
        shutil.copytree(folder, out, dirs_exist_ok=True, copy_function=os.replace)
