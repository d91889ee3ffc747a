"""One HTML file that shows a recorded run again: 3D, film, pictures, curves; it asks no network.

The page's modules, shared with the live page, go into the file by an import map of data: URLs.
"""

from __future__ import annotations

import json
import posixpath
import re
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np
import rospkg

from bullet_sim.formats.run_log import Mark
from bullet_sim.rendering.scene_text import SceneContent, scene_from_text
from sim_viewer.page_scene import Meshes, page_scene, pose_row

START = "replay/replay.js"
STYLES = ("style.css", "replay/replay.css")
IMPORT = re.compile(r"""(?<=\bfrom )(["'])(\.{1,2}/[^"']+)\1""")
# What the page needs and no more: even a script in a student's text could not ask the network.
POLICY = ("default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; "
          "img-src data: blob:; media-src blob:; connect-src data:")


@dataclass(frozen=True)
class Motion:
    """Scene, and poses (times, links, 7) of links by name: x, y, z in m and the quaternion."""

    scene: SceneContent
    names: Sequence[str]
    times: np.ndarray  # (n,), s, simulated
    poses: np.ndarray
    scripted: frozenset[str] = frozenset()  # those that physics does not move

    def speeds(self) -> np.ndarray:
        """m/s (n,) of the link that went farthest: the robot's first, as its model's begins."""
        models: dict[str, int] = {}  # their first links
        for column, name in enumerate(self.names):
            if name not in self.scripted:
                models.setdefault(name.partition("::")[0], column)
        if not models:
            return np.zeros(len(self.times))
        places = self.poses[:, list(models.values()), :3]
        steps = np.linalg.norm(np.diff(places, axis=0), axis=-1)
        farthest = steps[:, int(np.argmax(steps.sum(0)))]
        spans = np.diff(self.times)
        return np.concatenate([[0.0], farthest / np.where(spans > 0, spans, np.inf)])


@dataclass(frozen=True)
class Curve:
    """A curve over simulated time, s; `name` in English and in Chinese."""

    name: tuple[str, str]
    unit: str
    times: Sequence[float]
    values: Sequence[float]


@dataclass(frozen=True)
class Shown:
    """What the page shows beside the 3D view."""

    title: str
    text: str = ""  # the run's figures
    film: Path | None = None
    pictures: Sequence[Path] = ()
    curves: Sequence[Curve] = ()
    marks: Sequence[Mark] = ()  # moments worth going back to


MOST_MOMENTS = 3000  # in a page, of a link or a curve


def read_recording(path: Path) -> Motion | None:
    """The recording of the simulator's parameter `recording`; None if nothing was recorded.
    FormatError or ValueError if it is none.

    A second simulation's time goes on where the first one's ended; a link is where the scene had it
    before it is named, and where it was last seen after it is gone. Half a line, which a simulator
    leaves that was killed, is left out.
    """
    text = path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""
    scenes: list[SceneContent] = []
    names: list[str] = []
    scripted: set[str] = set()
    known: dict[str, None] = {}  # names in order
    moments: list[tuple[float, dict[str, list[float]]]] = []
    placed: dict[str, list[float]] = {}  # by the newest scene, until the next moment
    offset = last = 0.0
    for line in text.splitlines():
        try:
            read = json.loads(line[max(line.rfind('{"scene":'), 0):])  # behind half a line
        except ValueError:
            continue
        if "scene" in read:
            scenes.append(scene_from_text(read["scene"]))
            placed |= {f"{model}::{link}": pose_row(pose)
                       for (model, link), (pose, _) in scenes[-1].links.items()}
        elif "names" in read:
            names = read["names"]
            scripted.update(names[len(names) - read.get("scripted", 0):])
        else:
            offset += last if read["time"] <= last else 0.0
            last = read["time"]
            moments.append((offset + last, placed | dict(zip(names, read["poses"], strict=True))))
            known |= dict.fromkeys(names)
            placed = {}
    if len(moments) < 2 or not scenes:
        return None
    poses = np.empty((len(moments), len(known), 7), np.float32)
    for column, name in enumerate(known):
        row = next(there[name] for _, there in moments if name in there)
        for number, (_, there) in enumerate(moments):
            poses[number, column] = row = there.get(name, row)
    step = -(-len(moments) // MOST_MOMENTS)
    links = {key: link for content in scenes for key, link in content.links.items()}
    return Motion(SceneContent(scenes[-1].description, scenes[-1].lights, links),
                  list(known), np.array([time for time, _ in moments])[::step], poses[::step],
                  frozenset(scripted))


def replay_page(motion: Motion, shown: Shown) -> str:
    """The page's text; ValueError for a curve with a value that is no number."""
    meshes = Meshes()
    run = {
        "scene": page_scene(motion.scene, meshes), "names": list(motion.names),
        "files": {path: _url(kind, data) for path, (kind, data) in meshes.files().items()},
        "times": np.round(motion.times, 3).tolist(),
        "poses": b64encode(np.ascontiguousarray(motion.poses, "<f4").tobytes()).decode(),
        "title": shown.title, "text": shown.text,
        "film": shown.film and _url("video/mp4", shown.film.read_bytes()),
        "pictures": [_url("image/png", path.read_bytes()) for path in shown.pictures],
        "curves": [{"name": curve.name, "unit": curve.unit, **_shown_moments(curve)}
                   for curve in shown.curves if len(curve.times)],
        "marks": [list(mark) for mark in shown.marks],
    }
    web = Path(rospkg.RosPack().get_path("sim_viewer")) / "web"
    modules = {f"web/{path}": _url("text/javascript", text.encode())
               for path, text in _modules(web).items()}
    style = "".join((web / name).read_text(encoding="utf-8") for name in STYLES)
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<title>{escape(shown.title)}</title><link rel="icon" href="data:,">'
            f"<style>{style}</style>"
            f'<script type="importmap">{json.dumps({"imports": modules})}</script></head><body>'
            f'<script type="application/json" id="run">{_in_script(run)}</script>'
            f'<script type="module">import "web/{START}";</script></body></html>\n')


def _shown_moments(curve: Curve) -> dict[str, list[float]]:
    """At most MOST_MOMENTS: of neighbours the one farthest from 0, so that no peak is lost."""
    times, values = np.round(curve.times, 3), np.round(curve.values, 4)
    step = -(-len(times) // MOST_MOMENTS)
    rows = [at + int(np.argmax(np.abs(values[at:at + step]))) for at in range(0, len(times), step)]
    return {"times": times[rows].tolist(), "values": values[rows].tolist()}


def _modules(web: Path) -> dict[str, str]:
    """All modules that START needs, by path; they import each other by web/PATH."""
    found: dict[str, str] = {}
    wanted = [START]
    while wanted:
        path = wanted.pop()
        if path in found:
            continue
        here = posixpath.dirname(path)

        def named(match: re.Match, here: str = here) -> str:
            target = posixpath.normpath(posixpath.join(here, match[2]))
            wanted.append(target)
            return f'"web/{target}"'

        found[path] = IMPORT.sub(named, (web / path).read_text(encoding="utf-8"))
    return found


def _url(kind: str, data: bytes) -> str:
    return f"data:{kind};base64,{b64encode(data).decode()}"


def _in_script(values: dict) -> str:
    return json.dumps(values, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
