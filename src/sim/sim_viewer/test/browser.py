"""A browser without a screen that is told what to do by JSON over a WebSocket, and its tabs."""

from __future__ import annotations

import abc
import asyncio
import contextlib
import itertools
import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path

import aiohttp
import cv2
import numpy as np
from background import LIMIT, loop, run, wait_until

ENDS_WITHIN = 5.0  # s


class Browser(abc.ABC):
    """One with a profile of its own; `close` ends it and deletes the profile."""

    name: str

    def __init__(self) -> None:
        self.profile = Path(tempfile.mkdtemp(prefix=f"viewer-{self.name}-"))
        self._numbers = itertools.count(1)
        self._answers: dict[int, asyncio.Future] = {}
        self._client: aiohttp.ClientSession | None = None
        self._reader: asyncio.Task | None = None
        self.prepare()
        home = dict.fromkeys(("HOME", "TMPDIR"), str(self.profile))
        self.process = subprocess.Popen(
            self.command(), env={**os.environ, **home},
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True)
        try:
            run(self._connect(wait_until(self.address, f"{self.name}'s address")))
            self.begin()
        except BaseException:  # nobody else could end it
            self.close()
            raise

    def prepare(self) -> None:  # noqa: B027 (Chromium needs nothing)
        """Before it is started."""

    @abc.abstractmethod
    def command(self) -> list[str]:
        """What starts it."""

    @abc.abstractmethod
    def address(self) -> str | None:
        """Its WebSocket's, once it has written that into its profile."""

    def begin(self) -> None:  # noqa: B027 (Chromium needs nothing)
        """Once it can be told what to do."""

    @abc.abstractmethod
    def open(self, url: str) -> Page:
        """A new tab in front of the others."""

    @abc.abstractmethod
    def take(self, event: dict) -> None:
        """What it tells unasked."""

    def call(self, method: str, session: str | None = None, **params) -> dict:
        """One method of its protocol and the result."""
        return run(self._call(method, session, params))

    def close(self) -> None:
        self._signal(signal.SIGTERM)
        with contextlib.suppress(AssertionError):
            wait_until(lambda: not self._signal(0), f"an end of {self.name}", ENDS_WITHIN)
        self._signal(signal.SIGKILL)
        self.process.wait()
        if self._reader is not None:
            self._reader.cancel()
        if self._client is not None:
            run(self._client.close())
        wait_until(self._forget_profile, f"an end of {self.name}'s processes")

    def _signal(self, number: int) -> bool:
        """To all its processes; whether there is one."""
        self.process.poll()
        try:
            os.killpg(self.process.pid, number)
        except ProcessLookupError:
            return False
        return True

    def _forget_profile(self) -> bool:
        """Whether it is gone; a process that has not quite ended may still write there."""
        shutil.rmtree(self.profile, ignore_errors=True)
        return not self.profile.exists()

    async def _connect(self, url: str) -> None:
        self._client = aiohttp.ClientSession()
        self._socket = await self._client.ws_connect(url, max_msg_size=0)
        self._reader = loop.create_task(self._read())

    async def _call(self, method: str, session: str | None, params: dict) -> dict:
        number = next(self._numbers)
        answer = self._answers[number] = loop.create_future()
        await self._socket.send_json({"id": number, "method": method, "params": params}
                                     | ({"sessionId": session} if session else {}))
        return await answer

    async def _read(self) -> None:
        async for message in self._socket:
            data = message.json()
            answer = self._answers.pop(data.get("id"), None)
            if answer is not None and "error" in data:
                answer.set_exception(RuntimeError(str(data["error"])))
            elif answer is not None:
                answer.set_result(data["result"])
            elif "method" in data:
                self.take(data)


class Page(abc.ABC):
    """One tab. `errors`: what its scripts complained of."""

    def __init__(self) -> None:
        self.errors: list[str] = []

    @abc.abstractmethod
    def evaluate(self, script: str):
        """The value of a script's last expression; a promise is waited for."""

    def wait_for(self, script: str, limit: float = LIMIT):
        """The script's first true value."""
        return wait_until(lambda: self.evaluate(script), script, limit)

    @abc.abstractmethod
    def key(self, key: str, down: bool) -> None:
        """A key goes down or comes up, as from a keyboard."""

    def press(self, *keys: str) -> None:
        """Keys held together, the last one struck, as Control and Home."""
        for key in keys:
            self.key(key, True)
        for key in reversed(keys):
            self.key(key, False)

    def type(self, text: str) -> None:
        """Keys that write, for what has the focus."""
        for letter in text:
            self.press({"\n": "Enter"}.get(letter, letter))

    @abc.abstractmethod
    def mouse(self, kind: str, x: float, y: float, button: str = "left") -> None:
        """`kind`: Pressed, Moved, Released, of the left or right button; px of the page."""

    @abc.abstractmethod
    def png(self) -> bytes:
        """What is to be seen."""

    def picture(self) -> np.ndarray:
        """What is to be seen, (height, width, 3) BGR."""
        return cv2.imdecode(np.frombuffer(self.png(), np.uint8), cv2.IMREAD_COLOR)
