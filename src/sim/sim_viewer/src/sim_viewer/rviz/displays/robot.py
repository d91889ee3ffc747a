"""rviz/RobotModel: the links of robot_description, each where its frame is now."""

import numpy as np

from bullet_sim.errors import SimulationError
from sim_viewer.rviz.display_type import ERROR, OK, DisplayType, Drawer, NoTransform, Problem, View
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.options import Option

ASKED = 2.0  # s between reads of the parameter


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


TYPE = DisplayType("rviz/RobotModel", Robot, period=0.1, options=(
    Option("Robot Description", "text", "robot_description"),
    Option("TF Prefix", "text", ""), Option("Alpha", "number", 1.0, high=1)))
