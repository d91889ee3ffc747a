"""Starts a learner's lab: lessons, editor, terminals and the world in one browser window.

    python3 tools/lab [--ws FOLDER] [--port N]    until Ctrl-C; scripts/lab.sh runs it
    python3 tools/lab --ws FOLDER --reset FILE    brings a lesson's file back as it was

A lab has a ROS master, a page and a token of its own, all on 127.0.0.1. Exit code 1: it ended by
itself; 2: it could not start, and one line says why.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import secrets
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from http.client import HTTPConnection, HTTPException
from pathlib import Path

import rosgraph
from folder import Folder, LabError
from settings import lay_out, write_settings, write_terminal
from sim_viewer.options import TOKEN
from terminal_language.wanted import wanted_language

from run_session.failure import RunError
from run_session.master import free_port

HERE = Path(__file__).resolve().parent
START_TIME = 120.0  # s, wall, for page and JupyterLab each
TRIES = 3  # at a port, when several labs start at once
END_TIME = 20.0  # s, wall, for each of them to end
PERIOD = 0.1  # s, wall, between two looks


class Lab:
    """The processes of one lab; `close` ends them, the last started first."""

    def __init__(self, folder: Folder, language: str) -> None:
        self._folder, self._language = folder, language
        self._children: list[tuple[str, subprocess.Popen]] = []

    def start(self, wished: int | None, browser: bool) -> str:
        """Start all; returns the address with the token. LabError or RunError if one fails."""
        # At any free ports: only the lab's own terminals and its address lead there.
        master, page_token = f"http://localhost:{free_port(0)}", secrets.token_urlsafe(24)
        env = {"ROS_MASTER_URI": master, "ROS_HOSTNAME": "localhost"}
        self._run("page", "roslaunch", "sim_viewer", "viewer.launch", "control:=true",
                  f"port:={free_port(0)}", env=env | {TOKEN: page_token})  # and its master
        self._folder.fill()  # while the page starts
        page_port = int(self._wait("page", lambda: _page_url(master)).rstrip("/").split(":")[-1])
        write_terminal(self._folder, master)
        lay_out(self._folder, self._language)
        token, runtime = secrets.token_urlsafe(24), self._folder.state / "runtime"
        config = write_settings(self._folder, self._language, page_port, page_token, browser,
                                wished, token)
        own = {f"JUPYTER_{name.upper()}_DIR": str(self._folder.state / name)
               for name in ("config", "data", "runtime")}
        own |= {"LAB_LANGUAGE": self._language, "IPYTHONDIR": str(self._folder.state / "ipython"),
                "PYTHONPATH": os.pathsep.join([str(HERE), os.environ.get("PYTHONPATH", "")])}
        left = TRIES
        while True:
            shutil.rmtree(runtime, ignore_errors=True)  # a killed lab's, or the try's before
            self._run("jupyter", sys.executable, "-m", "jupyterlab", f"--config={config}",
                      env=env | own)
            try:
                port = self._wait("jupyter", lambda: _listening(runtime, token))
                return f"http://127.0.0.1:{port}/lab?token={token}"
            except LabError:
                left -= 1
                if not left or self._children[-1][1].poll() is None:
                    raise
                self._children.pop()  # another lab that starts has taken the port meanwhile

    def wait(self) -> str:
        """Until one of them ends; its name."""
        while True:
            for name, child in self._children:
                if child.poll() is not None:
                    return name
            time.sleep(PERIOD)

    def log(self, name: str) -> Path:
        """Where the output of one of them is."""
        return self._folder.state / f"{name}.log"

    def close(self) -> None:
        """End them, and what the terminals run."""
        for _, child in reversed(self._children):
            with contextlib.suppress(ProcessLookupError):
                child.send_signal(signal.SIGTERM)
            try:
                child.wait(END_TIME)
            except subprocess.TimeoutExpired:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()

    def _run(self, name: str, *command: str, env: dict[str, str]) -> None:
        # In a session of its own: Ctrl-C is for the lab, which then ends them one by one.
        with open(self.log(name), "w", encoding="utf-8") as log:
            self._children.append((name, subprocess.Popen(
                ["setpriv", "--pdeathsig", "TERM", *command], cwd=self._folder.path, stdout=log,
                stderr=log, stdin=subprocess.DEVNULL, start_new_session=True,
                env=os.environ | env)))

    def _wait(self, name: str, look: Callable[[], str | int]) -> str:
        child, until = dict(self._children)[name], time.monotonic() + START_TIME
        while not (found := look()):
            if child.poll() is not None or time.monotonic() > until:
                raise LabError(f"{name} did not start; its output is in {self.log(name)}")
            time.sleep(PERIOD)
        return str(found)


def _page_url(master: str) -> str:
    with contextlib.suppress(OSError, rosgraph.MasterException):
        return rosgraph.Master("/lab", master).getParam("/sim_viewer/url")
    return ""


def _listening(runtime: Path, token: str) -> int:
    """The port on which the server with this token listens; 0: not yet.

    Its file is there before that, also with a port that another one takes first.
    """
    with contextlib.suppress(StopIteration, ValueError, KeyError, OSError, HTTPException):
        port = json.loads(next(runtime.glob("jpserver-*.json")).read_text("utf-8"))["port"]
        connection = HTTPConnection("127.0.0.1", port, timeout=START_TIME)
        with contextlib.closing(connection):
            connection.request("GET", "/api/status", headers={"Authorization": f"token {token}"})
            return port if connection.getresponse().status == 200 else 0
    return 0


def check_port(wished: int) -> None:
    """LabError if it cannot be had."""
    if not 1024 <= wished <= 65535:
        raise LabError(f"port is {wished}; give one from 1024 to 65535, such as PORT=8889")
    if free_port(wished) != wished:
        raise LabError(f"port {wished} is taken: name another, such as PORT={wished + 1}, "
                       "or none, for the first free one")


def _has_browser() -> bool:
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="lab", description=__doc__.splitlines()[0])
    parser.add_argument("--ws", metavar="FOLDER", type=Path, default=Path("~/courses_ws"),
                        help="your own folder, made at first (~/courses_ws)")
    parser.add_argument("--port", metavar="N", type=int, help="of the lab (8888, or the next free)")
    parser.add_argument("--reset", metavar="FILE", help="bring a lesson's file back as it was")
    given = parser.parse_args()
    folder = Folder(given.ws)
    language = "zh" if wanted_language(dict(os.environ)) else "en"
    lab = Lab(folder, language)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    try:
        if given.reset is not None:
            print(f"lab: reset; your version is kept as {folder.reset(Path(given.reset))}")
            return 0
        if given.port is not None:
            check_port(given.port)  # before anything is made
        with folder.take() as lock:
            try:
                print(f"The lab is starting; your files are in {folder.package}", flush=True)
                url = lab.start(given.port, _has_browser())
                lock.write(url)
                lock.flush()
                print(f"lab: {url}\nOpen this address in a browser. Ctrl-C ends the lab; your "
                      "files stay.", flush=True)
                name = lab.wait()
                print(f"lab: {name} has ended, and with it the lab; its output is in "
                      f"{lab.log(name)}. Your files are saved; type make lab again.",
                      file=sys.stderr)
                return 1
            finally:
                lab.close()
    except (LabError, RunError) as error:
        print(f"lab: {error}", file=sys.stderr)
    except OSError as error:
        print(f"lab: {error.filename or folder.path}: {error.strerror}", file=sys.stderr)
    except KeyboardInterrupt:
        return 0
    return 2


if __name__ == "__main__":
    sys.exit(main())
