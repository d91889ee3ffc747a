"""One HTML file that shows a recorded run again: 3D, film, pictures, curves; it asks no network.

The page's modules, shared with the live page, go into the file by an import map of data: URLs.
"""

from __future__ import annotations

import json
import posixpath
import re
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

import numpy as np
import rospkg

from bullet_sim.rendering.scene_text import SceneContent, scene_from_text
from sim_viewer.page_scene import Meshes, page_scene

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

    def speeds(self) -> np.ndarray:
        """m/s (n,) of the link that went farthest: the robot's first, as its model's begins."""
        steps = np.linalg.norm(np.diff(self.poses[..., :3], axis=0), axis=-1)
        models = [name.partition("::")[0] for name in self.names]
        first = [models.index(model) for model in dict.fromkeys(models)]
        farthest = first[int(np.argmax(steps.sum(0)[first]))]
        return np.concatenate([[0.0], steps[:, farthest] / np.diff(self.times)])


@dataclass(frozen=True)
class Curve:
    """A curve over simulated time, s; `name` in English and in Chinese."""

    name: tuple[str, str]
    unit: str
    times: Sequence[float]
    values: Sequence[float]


@dataclass(frozen=True)
class Shown:
    """What stands beside the 3D view."""

    title: str
    text: str = ""  # the run's figures
    film: Path | None = None
    pictures: Sequence[Path] = ()
    curves: Sequence[Curve] = field(default_factory=list)


MOST_MOMENTS = 3000  # poses of a link in a page


def read_recording(path: Path) -> Motion | None:
    """The recording of the simulator's parameter `recording`; None if nothing was recorded.
    FormatError if its scene is none.

    A second simulation's time goes on where the first one's ended; a link is where it was first
    seen before it is there, and where it was last seen after it is gone.
    """
    scenes: list[str] = []
    names: list[str] = []
    moments: list[tuple[float, dict[str, list[float]]]] = []
    offset = last = 0.0
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        try:
            read = json.loads(line)
        except ValueError:  # the last line of a simulator that was killed
            break
        if "scene" in read:
            scenes.append(read["scene"])
        elif "names" in read:
            names = read["names"]
        else:
            offset += last if read["time"] < last else 0.0
            last = read["time"]
            moments.append((offset + last, dict(zip(names, read["poses"], strict=True))))
    if len(moments) < 2:
        return None
    moments = moments[::-(-len(moments) // MOST_MOMENTS)]
    known = list(dict.fromkeys(name for _, poses in moments for name in poses))
    poses = np.empty((len(moments), len(known), 7), np.float32)
    for column, name in enumerate(known):
        row = next(poses[name] for _, poses in moments if name in poses)
        for number, (_, there) in enumerate(moments):
            poses[number, column] = row = there.get(name, row)
    return Motion(_all_of(scenes), known, np.array([time for time, _ in moments]), poses)


def _all_of(scenes: Sequence[str]) -> SceneContent:
    """The last scene, with all links that ever were."""
    contents = [scene_from_text(text) for text in scenes]
    links = {key: link for content in contents for key, link in content.links.items()}
    return SceneContent(contents[-1].description, contents[-1].lights, links)


def replay_page(motion: Motion, shown: Shown) -> str:
    """The page's text."""
    meshes = Meshes()
    run = {
        "scene": page_scene(motion.scene, meshes), "names": list(motion.names),
        "files": {path: _url(kind, data) for path, (kind, data) in meshes.files().items()},
        "times": np.round(motion.times, 3).tolist(),
        "poses": b64encode(np.ascontiguousarray(motion.poses, "<f4").tobytes()).decode(),
        "title": shown.title, "text": shown.text,
        "film": shown.film and _url("video/mp4", shown.film.read_bytes()),
        "pictures": [_url("image/png", path.read_bytes()) for path in shown.pictures],
        "curves": [{"name": curve.name, "unit": curve.unit,
                    "times": np.round(curve.times, 3).tolist(),
                    "values": np.round(curve.values, 4).tolist()} for curve in shown.curves],
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
    return json.dumps(values, separators=(",", ":")).replace("<", "\\u003c")
