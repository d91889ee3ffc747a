"""Debian's Chromium without a screen, by its DevTools protocol: pages, keys, pictures, requests.

https://chromedevtools.github.io/devtools-protocol/ names every method and event used here.
"""

from __future__ import annotations

import base64
import shutil

import browser

FLAGS = [
    "--headless=new", "--no-first-run", "--disable-extensions", "--hide-scrollbars",
    "--no-sandbox",  # containers run as root, where Chromium's own sandbox refuses to start
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL, no GPU
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-default-apps", "--disable-dev-shm-usage", "--remote-debugging-port=0",
    "--window-size=1280,800", "--lang=en-US",
]
CODES = {  # of the keys that drive or change a drag: name of the place, Windows' virtual key code
    **{key: (f"Key{key.upper()}", ord(key.upper())) for key in "wasd"},
    "ArrowLeft": ("ArrowLeft", 37), "ArrowUp": ("ArrowUp", 38),
    "ArrowRight": ("ArrowRight", 39), "ArrowDown": ("ArrowDown", 40), " ": ("Space", 32),
    "Control": ("ControlLeft", 17), "Shift": ("ShiftLeft", 16), "Enter": ("Enter", 13),
    "End": ("End", 35), "Home": ("Home", 36), "F5": ("F5", 116),
    "PageDown": ("PageDown", 34),
}
MODIFIERS = {"Control": 2, "Shift": 8}  # bits of those that are held


BUTTONS = {"left": 1, "right": 2}  # bits of those that are held


class Browser(browser.Browser):
    """One Chromium."""

    name = "chromium"

    def __init__(self) -> None:
        self._pages: dict[str, Page] = {}
        super().__init__()

    def command(self) -> list[str]:
        return [shutil.which("chromium") or "chromium", *FLAGS, f"--user-data-dir={self.profile}",
                "about:blank"]

    def address(self) -> str | None:
        """Once it has written port and path."""
        file = self.profile / "DevToolsActivePort"
        lines = file.read_text().splitlines() if file.exists() else []
        return f"ws://127.0.0.1:{lines[0]}{lines[1]}" if len(lines) == 2 else None

    def open(self, url: str) -> Page:
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = self._pages[session] = Page(self, session, target)
        for domain in ("Page", "Runtime", "Network", "Log"):
            page.call(f"{domain}.enable")
        page.call("Page.navigate", url=url)
        return page

    def take(self, event: dict) -> None:
        page = self._pages.get(event.get("sessionId"))
        if page is not None:
            page.note(event["method"], event["params"])


class Page(browser.Page):
    """One tab. `requests`: the URLs it asked for."""

    def __init__(self, of: Browser, session: str, target: str) -> None:
        super().__init__()
        self._browser, self._session, self._target = of, session, target
        self.requests: list[str] = []
        self._modifiers = 0

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
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True,
                           returnByValue=True)
        if "exceptionDetails" in answer:
            raise AssertionError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def key(self, key: str, down: bool) -> None:
        code, number = CODES[key]
        bit = MODIFIERS.get(key, 0)
        self._modifiers = self._modifiers | bit if down else self._modifiers & ~bit
        self.call("Input.dispatchKeyEvent", type="rawKeyDown" if down else "keyUp", key=key,
                  code=code, windowsVirtualKeyCode=number, modifiers=self._modifiers)

    def type(self, text: str) -> None:
        for letter in text:
            key, written = ("Enter", "\r") if letter == "\n" else (letter, letter)
            code, number = CODES.get(key, ("", 0))
            of = {"key": key, "code": code, "windowsVirtualKeyCode": number}
            self.call("Input.dispatchKeyEvent", type="keyDown", text=written, **of)
            self.call("Input.dispatchKeyEvent", type="keyUp", **of)

    def mouse(self, kind: str, x: float, y: float, button: str = "left") -> None:
        self.call("Input.dispatchMouseEvent", type=f"mouse{kind}", x=x, y=y, button=button,
                  buttons=BUTTONS[button], clickCount=1, modifiers=self._modifiers)

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        """`kind`: touchStart, touchMove, touchEnd, touchCancel; points in px of the page."""
        self.call("Input.dispatchTouchEvent", type=kind,
                  touchPoints=[{"x": x, "y": y} for x, y in points])

    def png(self) -> bytes:
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def resize(self, width: int, height: int) -> None:
        """The page's size in px."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)

    def to_front(self) -> None:
        self.call("Page.bringToFront")

    def close(self) -> None:
        self._browser.call("Target.closeTarget", targetId=self._target)
