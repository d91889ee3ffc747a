"""The lab's page in a browser, used as a learner does: by the mouse and by keys."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from types import ModuleType

from running_lab import LIMIT, ROOT, Lab

sys.path.append(str(ROOT / "src/sim/sim_viewer/test"))

TILE, BUTTON = ".jp-LauncherCard", ".jp-Toolbar jp-button"
# The middle of the shown element with this text (any, where it is ""), if a click would meet it.
PLACE = """(() => {{
  for (const one of document.querySelectorAll({selector})) {{
    if ({text} && one.textContent.trim() !== {text}) continue;
    one.scrollIntoView({{ block: "nearest" }});
    const box = one.getBoundingClientRect();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const met = document.elementFromPoint(x, y);
    if (box.width && met && (one.contains(met) || met.contains(one))) return [x, y];
  }}
  return null;
}})()"""
EDITOR = ".jp-Document:not(.lm-mod-hidden) .jp-FileEditor .cm-content"
SHOWN = "document.querySelector({!r}) !== null"


class LabPage:
    """One tab with a lab; `browser`: the module chromium or firefox."""

    def __init__(self, lab: Lab, browser: ModuleType) -> None:
        self.lab = lab
        self._browser = browser.Browser()
        try:
            self.page = self._browser.open(f"{lab.base}/lab?token={lab.token}")
            self.page.resize(1600, 900)
            for part in (".jp-MarkdownViewer h1", ".jp-FileEditor", ".jp-Terminal", "iframe"):
                self.page.wait_for(SHOWN.format(part), LIMIT)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self._browser.close()

    def click(self, selector: str, text: str = "") -> None:
        """Wait until it is there and not covered, then click its middle."""
        script = PLACE.format(selector=json.dumps(selector), text=json.dumps(text))
        x, y = self.page.wait_for(script, LIMIT)
        for kind in ("Pressed", "Released"):
            self.page.mouse(kind, x, y)

    def tile(self, text: str) -> None:
        """Of the launcher, which is brought to the front."""
        if not self.page.evaluate("!!document.querySelector('.jp-LauncherCard')?.offsetParent"):
            self.click(".lm-TabBar-tab:has([data-icon='ui-components:launcher'])")
        self.click(TILE, text)

    def answer(self, text: str) -> None:
        """Choose or write this in the dialog that opens, and accept it."""
        field = ".jp-Dialog select, .jp-Dialog input"
        self.page.wait_for(f"document.activeElement?.matches({field!r})", LIMIT)
        self.page.type(text)
        self.page.press("Enter")
        self.page.wait_for("!document.querySelector('.jp-Dialog')", LIMIT)

    def open_lesson(self, name: str) -> Path:
        """By the tile; once its page and its script are shown. The script."""
        self.tile(self.said("open"))
        self.answer(f"learning_topic/{name}")
        self.click(".lm-TabBar-tab.lm-mod-current .lm-TabBar-tabLabel", name)
        self.page.wait_for(f"document.querySelector({EDITOR!r})?.textContent.includes('python3')",
                           LIMIT)
        return self.lab.ws / "src/my_lessons/scripts/learning_topic" / name

    def add(self, script: Path, after: str, new: str) -> None:
        """Write a line below the one that begins so; the editor keeps the indentation."""
        self._go_to(script, after)
        self.page.type(f"\n{new}")

    def _go_to(self, script: Path, line: str) -> None:
        """To the end of the line that begins so, as the file has it."""
        lines = script.read_text("utf-8").splitlines()
        number = next(at for at, each in enumerate(lines, 1) if each.strip().startswith(line))
        place = "document.querySelector('#jp-main-statusbar').textContent" \
                ".match(/(?:Ln|行) ?(\\d+)[,，] ?(?:Col|列) ?(\\d+)/)?.slice(1).map(Number)"
        self.click(f"{EDITOR} .cm-line")
        self.page.press("Control", "Home")
        self.page.wait_for(f"String({place}) === '1,1'", LIMIT)
        while (at := self.page.evaluate(place))[0] != number:  # a wrapped line takes several
            self.page.press("ArrowDown")
            self.page.wait_for(f"String({place}) !== '{at[0]},{at[1]}'", LIMIT)
        self.page.press("End")
        self.page.press("End")

    def run(self) -> None:
        """F5, in the editor that has the focus."""
        self.page.press("F5")

    def said(self, key: str) -> str:
        """A text of the lab's, in its language."""
        return self.lab.ask("/courses/menu")[1]["texts"][key]

    def world(self, script: str):
        """The value of an expression in the simulator's page: `page` is its document."""
        return self.page.evaluate(
            f"(page => {script})(document.querySelector('iframe')?.contentDocument)")

    def time(self) -> float:
        """s, simulated, as the simulator's page shows it; -1 without a simulator."""
        found = re.search(r"(\d+):([\d.]+)",
                          self.world("page?.querySelector('#simulation')?.textContent") or "")
        return 60 * int(found[1]) + float(found[2]) if found else -1.0
