"""Debian's Firefox on a screen that nobody sees, by WebDriver BiDi: pages, keys, mice, pictures.

https://w3c.github.io/webdriver-bidi/ names every method and event used here. Without a screen at
all this Firefox has no WebGL.
"""

from __future__ import annotations

import base64
import json

import browser

SETTINGS = {
    "webgl.force-enabled": True,  # by the processor
    "browser.startup.page": 0, "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False, "app.normandy.enabled": False,
    "network.captive-portal-service.enabled": False, "network.connectivity-service.enabled": False,
}
BUTTONS = {"left": 0, "right": 2}  # by number
KEYS = {"ArrowLeft": "\ue012", "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015",
        "Control": "\ue009", "Shift": "\ue008", "Enter": "\ue007", "Home": "\ue011",
        "End": "\ue010", "F5": "\ue035",
        "PageDown": "\ue00f"}


class Browser(browser.Browser):
    """One Firefox."""

    name = "firefox"

    def __init__(self) -> None:
        self._pages: dict[str, Page] = {}
        super().__init__()

    def begin(self) -> None:
        self.call("session.new", capabilities={})
        self.call("session.subscribe", events=["log.entryAdded", "network.beforeRequestSent"])

    def prepare(self) -> None:
        (self.profile / "user.js").write_text("".join(
            f"user_pref({json.dumps(name)}, {json.dumps(value)});\n"
            for name, value in SETTINGS.items()))

    def command(self) -> list[str]:
        return ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 1280x800x24",
                "firefox-esr", "--no-remote", "--profile", str(self.profile), "--width", "1280",
                "--height", "800", "--remote-debugging-port", "0", "about:blank"]

    def address(self) -> str | None:
        file = self.profile / "WebDriverBiDiServer.json"
        try:
            found = json.loads(file.read_text())
        except (OSError, ValueError):  # not there yet, or not whole
            return None
        return f"ws://{found['ws_host']}:{found['ws_port']}/session"

    def open(self, url: str) -> Page:
        context = self.call("browsingContext.create", type="tab")["context"]
        page = self._pages[context] = Page(self, context)
        page.call("browsingContext.navigate", url=url)
        return page

    def take(self, event: dict) -> None:
        values = event["params"]
        page = self._pages.get(values.get("context") or values.get("source", {}).get("context"))
        if page and event["method"] == "network.beforeRequestSent":
            page.requests.append(values["request"]["url"])
        elif page and event["method"] == "log.entryAdded" and values["level"] == "error":
            page.errors.append(values["text"])


class Page(browser.Page):
    """One tab. `requests`: the URLs it asked for."""

    def __init__(self, of: Browser, context: str) -> None:
        super().__init__()
        self.requests: list[str] = []
        self._browser, self._context = of, context

    def call(self, method: str, **params) -> dict:
        return self._browser.call(method, context=self._context, **params)

    def evaluate(self, script: str):
        answer = self._browser.call("script.evaluate", expression=script, awaitPromise=True,
                                    target={"context": self._context})
        if answer["type"] == "exception":
            raise AssertionError(f"{script}: {answer['exceptionDetails']['text']}")
        return plain(answer["result"])

    def key(self, key: str, down: bool) -> None:
        self._act("key", {"type": "keyDown" if down else "keyUp", "value": KEYS.get(key, key)})

    def mouse(self, kind: str, x: float, y: float, button: str = "left") -> None:
        change = {"Pressed": "pointerDown", "Released": "pointerUp"}.get(kind)
        self._act("pointer", {"type": "pointerMove", "x": round(x), "y": round(y)},
                  *([{"type": change, "button": BUTTONS[button]}] if change else []))

    def png(self) -> bytes:
        return base64.b64decode(self.call("browsingContext.captureScreenshot")["data"])

    def resize(self, width: int, height: int) -> None:
        """The page's size in px."""
        self.call("browsingContext.setViewport", viewport={"width": width, "height": height})

    def close(self) -> None:
        self.call("browsingContext.close")

    def _act(self, source: str, *actions: dict) -> None:
        self.call("input.performActions", actions=[
            {"type": source, "id": source, "actions": list(actions)}])


def plain(value: dict):
    """What BiDi's remote value stands for."""
    kind = value["type"]
    if kind == "array":
        return [plain(one) for one in value["value"]]
    if kind == "object":
        return {name: plain(one) for name, one in value["value"]}
    return value.get("value")
