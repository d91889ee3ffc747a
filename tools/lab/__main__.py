"""Starts a learner's lab: lessons, editor, terminals and the world in one browser window.

    python3 tools/lab [--ws FOLDER] [--port N]    until Ctrl-C; scripts/lab.sh runs it
    python3 tools/lab --ws FOLDER --reset FILE    brings a lesson's file back as it was

A lab has a ROS master, a page and a token of its own, all on 127.0.0.1. Exit code 1: it ended by
itself; 2: it could not start, and one line says why.
"""

from __future__ import annotations

import argparse
import contextlib
import http.client
import os
import secrets
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import NoReturn

import rosgraph
from folder import Folder, LabError
from settings import lay_out, write_settings, write_terminal
from sim_viewer.options import TOKEN
from terminal_language.wanted import wanted_language

from run_session.failure import RunError
from run_session.master import free_port, is_up, own_port, take_turn

FIRST_PORT, PORTS_TRIED = 8888, 100
PAGE_PORT = 8080
HERE = Path(__file__).resolve().parent
START_TIME = 60.0  # s, wall, for each of master, page and JupyterLab
END_TIME = 20.0  # s, wall, for each of them to end
PERIOD = 0.1  # s, wall, between two looks


class Lab:
    """The processes of one lab; `close` ends them, the last started first."""

    def __init__(self, folder: Folder, language: str) -> None:
        self._folder, self._language = folder, language
        self._children: list[tuple[str, subprocess.Popen]] = []

    def start(self, wished: int | None, browser: bool) -> str:
        """Start all; returns the address with the token. LabError or RunError if one fails."""
        master, page_token = self._start_master(), secrets.token_urlsafe(24)
        env = {"ROS_MASTER_URI": master, "ROS_HOSTNAME": "localhost"}
        self._run("page", "roslaunch", "sim_viewer", "viewer.launch", "control:=true",
                  f"port:={free_port(PAGE_PORT)}", env=env | {TOKEN: page_token})
        self._folder.fill()  # while the page starts
        page_port = int(self._wait("page", lambda: _page_url(master)).rstrip("/").split(":")[-1])
        write_terminal(self._folder, master)
        lay_out(self._folder, self._language)
        while True:
            port, token = choose_port(wished), secrets.token_urlsafe(24)
            config = write_settings(self._folder, self._language, port, token, page_port,
                                    page_token, browser)
            try:
                self._start_jupyter(config, env, port, token)
                return f"http://127.0.0.1:{port}/lab?token={token}"
            except LabError:
                if wished is not None or free_port(port) == port:
                    raise
                self._children.pop()  # another lab that starts was there first

    def _start_jupyter(self, config: Path, env: dict[str, str], port: int, token: str) -> None:
        state = self._folder.state
        self._run("jupyter", sys.executable, "-m", "jupyterlab", f"--config={config}",
                  env=env | {"LAB_LANGUAGE": self._language, "PYTHONPATH": os.pathsep.join(
                      [str(HERE), os.environ.get("PYTHONPATH", "")]),
                      "JUPYTER_CONFIG_DIR": str(state / "config"),
                      "JUPYTER_DATA_DIR": str(state / "data"),
                      "JUPYTER_RUNTIME_DIR": str(state / "runtime"),
                      "IPYTHONDIR": str(state / "ipython")})
        self._wait("jupyter", lambda: _answers(port, token))

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

    def _start_master(self) -> str:
        # The turn that all commands take who choose a port for a master (take_turn of common.sh).
        folder = Path(os.environ.get("TMPDIR") or tempfile.gettempdir())
        with take_turn(folder / f"course_run-{os.getuid()}.lock"):
            port, _ = own_port(joined=True)
            self._run("master", "roscore", "-p", str(port), env={})
            uri = f"http://localhost:{port}"
            self._wait("master", lambda: is_up(uri))
        return uri

    def _run(self, name: str, *command: str, env: dict[str, str]) -> None:
        # In a session of its own: Ctrl-C is for the lab, which then ends them one by one.
        with open(self.log(name), "w", encoding="utf-8") as log:
            self._children.append((name, subprocess.Popen(
                ["setpriv", "--pdeathsig", "TERM", *command], cwd=self._folder.path, stdout=log,
                stderr=log, stdin=subprocess.DEVNULL, start_new_session=True,
                env=os.environ | env)))

    def _wait(self, name: str, look: Callable[[], str | bool]) -> str:
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


def _answers(port: int, token: str) -> bool:
    """Whether our own Jupyter server answers there, and no other."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=START_TIME)
    try:
        connection.request("GET", "/courses/menu", headers={"Authorization": f"token {token}"})
        return connection.getresponse().status == 200
    except (OSError, http.client.HTTPException):
        return False
    finally:
        connection.close()


def choose_port(wished: int | None) -> int:
    """The port wished for, or the first free one from 8888; LabError if there is none."""
    if wished is not None:
        if not 1024 <= wished <= 65535:
            raise LabError(f"port is {wished}; give one from 1024 to 65535, such as PORT=8889")
        if free_port(wished) != wished:
            raise LabError(f"port {wished} is taken: name another, such as PORT={wished + 1}, "
                           "or none, for the first free one")
        return wished
    for port in range(FIRST_PORT, FIRST_PORT + PORTS_TRIED):
        if free_port(port) == port:
            return port
    raise LabError(f"ports {FIRST_PORT} to {FIRST_PORT + PORTS_TRIED - 1} are all taken: name "
                   "another, such as PORT=9000")


def _interrupted(number: int, frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt


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
        signal.signal(number, _interrupted)
    try:
        if given.reset is not None:
            print(f"lab: reset; your version is kept as {folder.reset(Path(given.reset))}")
            return 0
        choose_port(given.port)  # before anything is made
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
