"""Debian's Chromium without a screen, by its DevTools protocol: pages, keys, pictures, requests.

https://chromedevtools.github.io/devtools-protocol/ names every method and event used here.
"""

from __future__ import annotations

import asyncio
import base64
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

FLAGS = [
    "--headless=new", "--no-first-run", "--disable-extensions", "--hide-scrollbars",
    "--no-sandbox",  # containers run as root, where Chromium's own sandbox refuses to start
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL, no GPU
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-default-apps", "--disable-dev-shm-usage", "--remote-debugging-port=0",
    "--window-size=1280,800", "--lang=en-US",
]
CODES = {  # of the keys that drive: name of the place, Windows' virtual key code
    **{key: (f"Key{key.upper()}", ord(key.upper())) for key in "wasd"},
    "ArrowLeft": ("ArrowLeft", 37), "ArrowUp": ("ArrowUp", 38),
    "ArrowRight": ("ArrowRight", 39), "ArrowDown": ("ArrowDown", 40), " ": ("Space", 32),
}


class Browser:
    """One Chromium with a profile of its own; `close` ends it and deletes the profile."""

    def __init__(self) -> None:
        self._profile = Path(tempfile.mkdtemp(prefix="viewer-chromium-"))
        self._numbers = itertools.count(1)
        self._answers: dict[int, asyncio.Future] = {}
        self._pages: dict[str, Page] = {}
        self.process = subprocess.Popen(
            [shutil.which("chromium") or "chromium", *FLAGS,
             f"--user-data-dir={self._profile}", "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True)
        port, path = wait_until(self._address, "Chromium's DevTools port")
        run(self._connect(f"ws://127.0.0.1:{port}{path}"))

    def open(self, url: str) -> Page:
        """A new tab in front of the others."""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = self._pages[session] = Page(self, session, target)
        for domain in ("Page", "Runtime", "Network", "Log"):
            page.call(f"{domain}.enable")
        page.call("Page.navigate", url=url)
        return page

    def call(self, method: str, session: str | None = None, **params) -> dict:
        """One method of the protocol and its result."""
        return run(self._call(method, session, params))

    def close(self) -> None:
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass  # all are gone already
        self.process.wait()
        self._reader.cancel()
        run(self._client.close())
        wait_until(self._forget_profile, "an end of Chromium's processes")

    def _forget_profile(self) -> bool:
        """Whether it is gone; a process that has not quite ended may still write there."""
        shutil.rmtree(self._profile, ignore_errors=True)
        return not self._profile.exists()

    def _address(self) -> list[str] | None:
        """Port and path, once Chromium has written both."""
        file = self._profile / "DevToolsActivePort"
        lines = file.read_text().splitlines() if file.exists() else []
        return lines if len(lines) == 2 else None

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
                answer.set_exception(RuntimeError(data["error"]["message"]))
            elif answer is not None:
                answer.set_result(data["result"])
            elif data.get("sessionId") in self._pages:
                self._pages[data["sessionId"]].note(data["method"], data["params"])


class Page:
    """One tab. `requests`: the URLs it asked for. `errors`: what its scripts complained of."""

    def __init__(self, browser: Browser, session: str, target: str) -> None:
        self._browser, self._session, self._target = browser, session, target
        self.requests: list[str] = []
        self.errors: list[str] = []

    def note(self, method: str, params: dict) -> None:
        """One event of the protocol."""
        if method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        elif method == "Network.webSocketCreated":
            self.requests.append(params["url"])
        elif method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(f"{params['entry']['text']} {params['entry'].get('url', '')}")

    def call(self, method: str, **params) -> dict:
        return self._browser.call(method, self._session, **params)

    def evaluate(self, script: str):
        """The value of a script's last expression; a promise is waited for."""
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True,
                           returnByValue=True)
        if "exceptionDetails" in answer:
            raise AssertionError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait_for(self, script: str, limit: float = LIMIT):
        """The script's first true value."""
        return wait_until(lambda: self.evaluate(script), script, limit)

    def key(self, key: str, down: bool) -> None:
        """A key goes down or comes up, as from a keyboard."""
        code, number = CODES[key]
        self.call("Input.dispatchKeyEvent", type="rawKeyDown" if down else "keyUp", key=key,
                  code=code, windowsVirtualKeyCode=number)

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        """`kind`: touchStart, touchMove, touchEnd, touchCancel; points in px of the page."""
        self.call("Input.dispatchTouchEvent", type=kind,
                  touchPoints=[{"x": x, "y": y} for x, y in points])

    def picture(self) -> np.ndarray:
        """What is to be seen, (height, width, 3) BGR."""
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)

    def resize(self, width: int, height: int) -> None:
        """The page's size in px."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)

    def to_front(self) -> None:
        self.call("Page.bringToFront")

    def close(self) -> None:
        self._browser.call("Target.closeTarget", targetId=self._target)
