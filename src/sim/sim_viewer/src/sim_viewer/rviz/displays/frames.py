"""What tf places: rviz/TF (axes of all frames, their parents and names) and rviz/RobotModel."""

import numpy as np

from bullet_sim.errors import SimulationError
from sim_viewer.rviz.display_type import ERROR, OK, DisplayType, Drawer, NoTransform, Problem, View
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.geometry import arrows, axes, towards
from sim_viewer.rviz.options import Option

AXIS = (0.2, 0.02)  # m: length, radius, at scale 1 (rviz's own cross is of this size, too)
SHAFT, HEAD = 0.01, 0.02  # m: diameters of arrows, at scale 1
HEAD_LENGTH = 0.08  # m
ARROW = (255, 150, 178, 255)
TEXT = (255, 255, 255, 255)
TEXT_HEIGHT, TEXT_ABOVE = 0.1, 0.27  # m: so that the axes do not cross it
ASKED = 2.0  # s between reads of the parameter


class Frames(Drawer):
    """All frames that have a transform to the fixed frame."""

    def draw(self, view: View) -> list[Part]:
        parents = view.frames()
        placed, statuses = {}, {"Transform": (OK, "Transform OK")}
        for frame in sorted(parents):
            try:
                pose = view.pose(frame)
                placed[frame] = np.array([*pose.position, *pose.orientation])
            except NoTransform:
                statuses[frame] = (
                    ERROR, f"No transform from [{frame}] to frame [{view.fixed_frame}]")
        self.statuses = statuses
        if not placed:
            return []
        return self._parts(placed, parents)

    def _parts(self, placed: dict[str, np.ndarray], parents: dict[str, str]) -> list[Part]:
        scale, options = self.options["Marker Scale"], self.options
        rows = np.array(list(placed.values()))
        parts = axes(rows, AXIS[0] * scale, AXIS[1] * scale) if options["Show Axes"] else []
        pairs = [(placed[frame], placed[parent]) for frame, parent in parents.items()
                 if frame in placed and parent in placed]
        if options["Show Arrows"] and pairs:
            parts += _links(np.array(pairs), scale)
        if options["Show Names"]:
            above = np.array([0.0, 0.0, TEXT_ABOVE * scale])
            parts.append(Part("texts", fields={"texts": [
                {"text": frame, "position": (row[:3] + above).tolist(), "colour": TEXT,
                 "height": TEXT_HEIGHT * scale} for frame, row in placed.items()]}))
        return parts


def _links(pairs: np.ndarray, scale: float) -> list[Part]:
    """Arrows from each frame to its parent; pairs (n, 2, 7)."""
    gaps = pairs[:, 1, :3] - pairs[:, 0, :3]
    lengths = np.linalg.norm(gaps, axis=1)
    long = lengths > 1e-4
    rows = np.hstack([pairs[:, 0, :3], towards(gaps)])[long]
    head = np.minimum(HEAD_LENGTH * scale, lengths[long] / 2)
    return arrows(rows, (lengths[long] - head, SHAFT * scale), (head, HEAD * scale), ARROW)


TF = DisplayType("rviz/TF", Frames, period=0.1, options=(
    Option("Show Names", "switch", True), Option("Show Axes", "switch", True),
    Option("Show Arrows", "switch", True), Option("Marker Scale", "number", 1.0, low=1e-3)))


class Robot(Drawer):
    """Links without a transform are left out, and listed."""

    _text: str | None = None
    _asked = -np.inf
    _problem: Problem | None = None

    def draw(self, view: View) -> list[Part]:
        self._read(view)
        prefix = self.options["TF Prefix"].strip("/")
        visuals, rows = {}, []
        statuses = {"URDF": (OK, "URDF parsed OK")}
        for link, shown in self._links.items():
            frame = f"{prefix}/{link}" if prefix else link
            try:
                pose = view.pose(frame)
            except NoTransform:
                statuses[link] = (ERROR,
                                  f"No transform from [{frame}] to [{view.fixed_frame}]")
                continue
            if shown:
                visuals[link] = shown
                rows.append([*pose.position, *pose.orientation])
        self.statuses = statuses
        if not visuals:
            return []
        return [Part("links", {"rows": np.array(rows, np.float32)},
                     {**view.links(visuals), "alpha": self.options["Alpha"]})]

    def _read(self, view: View) -> None:
        if view.wall - self._asked >= ASKED:
            self._asked = view.wall
            self._problem = self._look(view)
        if self._problem:
            raise self._problem

    def _look(self, view: View) -> Problem | None:
        name = self.options["Robot Description"]
        text = view.parameter(name)
        if not text:
            self._text = None
            return Problem(
                f"Parameter [{name}] does not exist, and was not found by searchParam()")
        if text != self._text:
            try:
                self._links = view.robot(str(text))
            except SimulationError as error:
                return Problem(f"URDF failed Model parse: {error}")
            self._text = text
        return None


ROBOT_MODEL = DisplayType("rviz/RobotModel", Robot, period=0.1, options=(
    Option("Robot Description", "text", "robot_description"),
    Option("TF Prefix", "text", ""), Option("Alpha", "number", 1.0, high=1)))
