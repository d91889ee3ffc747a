"""The page "it says X, type Y": every line of ours that names what to do, and ROS's commonest."""

from __future__ import annotations

import re
import sys
from collections import defaultdict

import yaml
from staging import HERE, ROOT, Pages

sys.path.append(str(ROOT / "scripts"))
from terminal_texts import LOCALES, unquoted

ADVICE = re.compile(
    r"(?:; |\. |: |, )((?:(?:then |else |in each new terminal |in the repository )?"
    r"(?:add|allow|answer|ask|build|call|choose|close|connect|correct|delete|end|export|give|"
    r"go|install|leave|let|load|look|make|mend|move|name|open|press|put|remove|rename|run|"
    r"see|send|set|source|spawn|start|stop|take|try|type|unset|use|wait|write)\b).*)$",
    re.IGNORECASE | re.DOTALL)
SAYS = {"en": ("# It says X, type Y",
               "What programs print, and what to do then. `…` stands for a name or a number. "
               "The search finds a line by its words.",
               "## Lines of ROS, Python and the system", "## Lines of these courses",
               "| it says | do |"),
        "zh": ("# 出现这句话，就这样做",
               "程序打印的话，以及接下来怎么做。`…` 代表名称或数字。用搜索框可以按词找到某一行。",
               "## ROS、Python 和系统的提示", "## 本课程的提示",
               "| 英文 | 中文，和要做的 |")}
ENTRY = re.compile(r'^((?:#: .*\n)+)(?:msgctxt .*\n)?msgid ((?:".*"\n)+)msgstr ((?:".*"\n)+)',
                   re.MULTILINE)


def advice() -> dict[str, list[tuple[str, str, str]]]:
    """By the file that prints it: what an English line says, its advice, and the Chinese line."""
    found = defaultdict(list)
    for name in ("courses", "courses-shell"):
        for places, *texts in ENTRY.findall((LOCALES / f"{name}.po").read_text("utf-8")):
            english, chinese = ("".join(map(unquoted, re.findall(r'^"(.*)"$', text, re.MULTILINE)))
                                for text in texts)
            place = places.split()[1]
            if "/" in place and (match := ADVICE.search(english)):
                found[place].append((english[:match.start()], match[1], chinese))
    return dict(sorted(found.items()))


def add_advice(pages: Pages) -> None:
    """Add the page."""
    common = yaml.safe_load((HERE / "errors.yaml").read_text("utf-8"))
    ours = advice()
    for language, texts in pages.texts.items():
        title, text, first, second, head = SAYS[language]
        lines = [title, "", text, "", first, "", head if language == "en" else "| 显示 | 怎么做 |",
                 "|---|---|", *(f"| {_line(each['says'])} | {each[language]} |" for each in common),
                 "", second, ""]
        for place, rows in ours.items():
            lines += [f"### {place.removeprefix('src/')}", "", head, "|---|---|"]
            lines += [f"| {_line(says)} | {_line(do if language == 'en' else chinese)} |"
                      for says, do, chinese in rows] + [""]
        texts["reference/advice.md"] = "\n".join(lines)


def _line(text: str) -> str:
    """As code in a table's cell, with … for a value."""
    text = re.sub(r"\{\d+\}|\$\{?\w+\}?|%[sd]", "…", text)
    text = " ".join(text.split())
    return f"`` {text} ``" if "`" in text else f"`{text}`" if text else ""
