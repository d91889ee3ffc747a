"""The page "from this course to ROS 2", and for each package a page of its lessons for rclpy."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import PurePosixPath

from rclpy_text import RULES, Program
from staging import BROKEN, HERE, ROOT, SAYS, Pages, table, tracked

PLACES = re.compile(r"src/(?:lessons/)?(?P<package>[^/]+)/")
SPEAKS = re.compile(r"\b(rospy|rosbag|actionlib|rosgraph)\b|car_control\.node")


def lessons() -> dict[str, str]:
    """PACKAGE/FILE of each lesson in Python, and of each module named in the rules -> its path."""
    found = {}
    for path in tracked():
        package, name = PLACES.match(path), PurePosixPath(path).name
        if package and (package[1] in ("learning_topic", "car_control") or "/lessons/" in path) \
                and not re.search("/(test|exercises|solutions)/", path):
            key = f"{package[1]}/{name}"
            text = (ROOT / path).read_bytes() if (ROOT / path).stat().st_mode & 0o100 else b""
            program = text.startswith(b"#!/usr/bin/env python3") and not (
                ROOT / f"{path}.py").exists()  # talker and talker.py are one
            if program or key in RULES["files"] or key in RULES["instead"]:
                found[key] = path
    return found


def packages() -> set[str]:
    """All packages of lessons."""
    return {"learning_topic", "car_control"} | {
        path.parent.name for path in (ROOT / "src/lessons").glob("*/package.xml")}


def twin(name: str, path: str) -> str | None:
    """A lesson for rclpy; None if it stays as it is. ValueError names what no rule is for."""
    own, source = HERE / "twins" / name, (ROOT / path).read_text("utf-8")
    if own.exists():
        return own.read_text("utf-8")
    try:
        return Program(source, name).text() if SPEAKS.search(source) else None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def twins() -> dict[str, str | None]:
    """All lessons for rclpy, and the files that are shown beside them, by PACKAGE/FILE."""
    found = {name: twin(name, path) for name, path in lessons().items()
             if name not in RULES["instead"]}
    beside = {str(path.relative_to(HERE / "twins")): path.read_text("utf-8")
              for path in (HERE / "twins").glob("*/*")}
    return dict(sorted((beside | found).items()))


def add_ros2(pages: Pages) -> None:
    """Add all pages."""
    shown = twins()
    for language, texts in pages.texts.items():
        says, parts, names = SAYS[language], defaultdict(list), defaultdict(list)
        for name, text in sorted((shown | RULES["instead"]).items()):
            package, _, file = name.partition("/")
            told = (says["stays"] if text is None else text[language] if isinstance(text, dict)
                    else f"```python\n{text}```")
            if RULES["files"].get(name, {}).get("part"):
                told = f"{says['module']}\n\n{told}"
            parts[package] += [f"## {file}\n" if file else "", told, ""]
            names[package] += [f"`{file}`"] if file else [told]
        for package, told in parts.items():
            lesson = next(path for path in (f"src/{package}", f"src/lessons/{package}")
                          if (ROOT / path).exists())
            texts[f"docs/ros2/{package}.md"] = "\n".join(
                [f"# {says['ros2 title'].format(package)}", "",
                 says["ros2 links"].format(f"../../{lesson}/README.md"), "", *told])
        rows = [(f"[{package}](ros2/{package}.md)", " ".join(names[package]))
                for package in sorted(parts)]
        text = BROKEN.sub("", (HERE / f"ros2.{language}.md").read_text("utf-8"))
        texts["docs/ros2.md"] = text.replace(
            "{{lessons}}", "\n".join(table(language, "package, programs", rows)))
