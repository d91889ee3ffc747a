"""A lab that runs for a test: started, asked, and ended; what its terminals show."""

import asyncio
import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from dataclasses import dataclass
from pathlib import Path

import aiohttp
import psutil

ROOT = Path(__file__).resolve().parent.parent
TOOL = ROOT / "tools/lab"
LIMIT = 180.0  # s
SCRIPTS = "src/my_lessons/scripts/learning_topic"


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(look, what: str, limit: float = LIMIT):
    until = time.monotonic() + limit
    while not (found := look()):
        assert time.monotonic() < until, f"no {what} within {limit} s"
        time.sleep(0.1)
    return found


@dataclass
class Lab:
    """A running one: its process, output, folder, and what its address says."""

    process: subprocess.Popen
    output: Path
    ws: Path
    base: str = ""
    token: str = ""

    def ask(self, path: str, body: dict | None = None, token: str | None = None,
            method: str | None = None) -> tuple[int, dict | list | str]:
        """Status and answer of the lab's server; `token`: another than its own, "" for none."""
        shown = self.token if token is None else token
        request = urllib.request.Request(
            self.base + path, data=None if body is None else json.dumps(body).encode(),
            headers={"Authorization": f"token {shown}"} if shown else {}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                status, text = answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            status, text = error.code, error.read().decode()
        try:
            return status, json.loads(text)
        except ValueError:
            return status, text

    def do(self, act: str, what: str) -> tuple[int, dict]:
        return self.ask("/courses/do", {"act": act, "what": what})

    def shown(self, terminal: str, pattern: str, limit: float = LIMIT) -> str:
        """The terminal's text, once it is there and the pattern is in it."""
        wait_until(lambda: any(each["name"] == terminal for each in self.ask("/api/terminals")[1]),
                   f"terminal {terminal}")
        return asyncio.run(self._shown(terminal, pattern, limit))

    async def _shown(self, terminal: str, pattern: str, limit: float) -> str:
        text = ""
        address = f"{self.base}/terminals/websocket/{terminal}?token={self.token}"
        with contextlib.suppress(TimeoutError):
            async with (asyncio.timeout(limit), aiohttp.ClientSession() as http,
                        http.ws_connect(address) as link):
                async for message in link:
                    kind, *rest = json.loads(message.data)
                    text += rest[0] if kind == "stdout" else ""
                    if re.search(pattern, text, re.DOTALL):
                        return text
        raise AssertionError(f"no {pattern} in the terminal {terminal}: {text}")

    def positions(self, count: int = 1) -> list[tuple[float, float]]:
        """Where the robot is, in m, in so many messages of its odometry."""
        said = subprocess.run(
            ["rostopic", "echo", "-p", "-n", str(count), "/odom/pose/pose/position"],
            env={**os.environ, "ROS_MASTER_URI": self.master()}, timeout=LIMIT,
            capture_output=True, text=True, check=True).stdout
        rows = [line.split(",") for line in said.splitlines() if line and line[0].isdigit()]
        return [(float(row[1]), float(row[2])) for row in rows]

    def master(self) -> str:
        text = (self.ws / ".lab/bashrc").read_text()
        return re.search(r"ROS_MASTER_URI=(\S+)", text)[1]


def started(folder: Path, *words: str, language: str = "en") -> Lab:
    """A lab that has printed its address, or has ended."""
    folder.mkdir(exist_ok=True)
    output, ws = folder / "output.txt", folder / "ws"
    env = {**os.environ, "HOME": str(folder), "LANGUAGE": language}
    for name in ("ROS_MASTER_URI", "DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        env.pop(name, None)
    with output.open("wb") as file:
        process = subprocess.Popen([sys.executable, TOOL, "--ws", ws, *words], env=env,
                                   stdout=file, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, start_new_session=True)
    lab = Lab(process, output, ws)
    found = wait_until(lambda: re.search(r"lab: (http://\S+)/lab\?token=(\S+)", output.read_text())
                       or process.poll() is not None, "address")
    assert found is not True, output.read_text()
    lab.base, lab.token = found[1], found[2]
    return lab


def ended(lab: Lab) -> int:
    """End it by Ctrl-C; its exit code. No process of it may be left."""
    family = psutil.Process(lab.process.pid).children(recursive=True)
    lab.process.send_signal(signal.SIGINT)
    code = lab.process.wait(LIMIT)
    left = psutil.wait_procs(family, timeout=30)[1]
    assert not left, left
    return code


def page_port(lab: Lab) -> int:
    config = json.loads((lab.ws / ".lab/config.json").read_text())
    return config["ServerProxy"]["servers"]["simulator"]["port"]
