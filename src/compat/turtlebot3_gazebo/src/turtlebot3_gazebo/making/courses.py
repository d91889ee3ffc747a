"""The floors of the two AutoRace courses: lanes, parking, start and crossing, seen from above."""

from __future__ import annotations

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.lanes import Painter
from turtlebot3_gazebo.making.painting import RED, WHITE, YELLOW, Canvas, Point

SIDE = 4.0  # m
FLOOR_2017, FLOOR_2020 = (10, 10, 10), (0, 0, 0)
# Driven in this order; the tunnel lies between the end and the start. Signs stand beside the lanes.
WAY_2017: tuple[Point, ...] = ((0.0, -1.787), (1.787, -1.787), (1.787, 1.787), (-1.787, 1.787),
                               (-1.787, 0.0))
WAY_2020: tuple[Point, ...] = (
    (0.0, -1.747), (1.747, -1.747), (1.747, -0.93), (0.35, -0.93), (0.35, -0.14), (1.62, -0.14),
    (1.62, 1.747), (-0.45, 1.747), (-0.9, 1.25), (-1.72, 1.25), (-1.72, 0.0),
)
LANE_2020 = 0.3, 0.25  # m: radius of its bends, width
COURSE_MODEL = """  <model name="course">
    <static>true</static>
    <link name="course_link">
      <collision name="course_collision">
        <geometry><plane><normal>0 0 1</normal><size>4 4</size></plane></geometry>
        <surface><friction><ode><mu>100</mu><mu2>50</mu2></ode></friction></surface>
      </collision>
      <visual name="course_visual">
        <cast_shadows>false</cast_shadows>
        <geometry><plane><normal>0 0 1</normal><size>4 4</size></plane></geometry>
        <material>
          <script>
            <uri>model://{folder}/materials/scripts</uri>
            <uri>model://{folder}/materials/textures</uri>
            <name>course</name>
          </script>
        </material>
      </visual>
    </link>
  </model>"""


def bay(painter: Painter, left: float, low: float, right: float, high: float, open_at: str) -> None:
    """A parking bay of white lines, one of its sides broken."""
    corners = {"west": ((left, low), (left, high)), "east": ((right, low), (right, high)),
               "south": ((left, low), (right, low)), "north": ((left, high), (right, high))}
    for side, ends in corners.items():
        if side == open_at:
            painter.dashes(*ends, WHITE)
        else:
            painter.line(ends, WHITE)


def course_2017() -> Canvas:
    """One lane round the square; parking inside of the east side, a stop line before the bar."""
    canvas = Canvas(2048, SIDE, FLOOR_2017)
    painter = Painter(canvas, yaw=-1.54, line_width=0.018)
    painter.lane(WAY_2017, radius=0.4, width=0.296)
    painter.area([(1.62, 0.75), (1.66, 0.75), (1.66, 1.05), (1.62, 1.05)], FLOOR_2017)  # a gap
    painter.dashes((1.639, 0.75), (1.639, 1.05), YELLOW)
    bay(painter, 1.1, 0.45, 1.5, 0.8, "north")
    bay(painter, 1.1, 1.0, 1.5, 1.35, "south")
    painter.line([(-1.92, 0.7), (-1.66, 0.7)], WHITE, 0.03)
    return canvas


def course_2020() -> Canvas:
    """A lane with an intersection, a building site, parking, a crossing; it ends at the tunnel."""
    canvas = Canvas(1024, SIDE, FLOOR_2020)
    painter = Painter(canvas, yaw=-3.14, line_width=0.02)
    painter.lane(WAY_2020, *LANE_2020)
    painter.line([(0.95, -1.86), (0.95, -1.63)], RED, 0.035)  # the start
    short_cut(painter)
    parking(painter)
    painter.line([(-1.83, 0.68), (-1.61, 0.68)], WHITE, 0.03)
    return canvas


def short_cut(painter: Painter) -> None:
    """The way over the intersection that a sign forbids: from lane to lane at x = 1.05."""
    for y in (-0.805, -0.265):  # mouths in the lines of both lanes
        painter.area([(0.94, y - 0.03), (1.16, y - 0.03), (1.16, y + 0.03), (0.94, y + 0.03)],
                     FLOOR_2020)
    painter.line([(0.925, -0.805), (0.925, -0.265)], YELLOW)
    painter.line([(1.175, -0.805), (1.175, -0.265)], WHITE)


def parking(painter: Painter) -> None:
    """Two bays, left and right of a way that leaves the northern lane at x = 0.48."""
    painter.area([(0.37, 1.59), (0.59, 1.59), (0.59, 1.65), (0.37, 1.65)], FLOOR_2020)
    painter.dashes((0.355, 1.6), (0.355, 1.0), WHITE)
    painter.dashes((0.605, 1.6), (0.605, 1.0), WHITE)
    painter.line([(0.355, 0.6), (0.605, 0.6)], WHITE)
    bay(painter, 0.605, 0.6, 0.905, 1.0, "west")
    bay(painter, 0.055, 0.6, 0.355, 1.0, "east")


def courses() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    files: dict[str, bytes] = {}
    for folder, canvas in (("turtlebot3_autorace/autorace_course", course_2017()),
                           ("turtlebot3_autorace_2020/course", course_2020())):
        files |= sdf.model_files(folder, COURSE_MODEL.format(folder=folder),
                                 "A black floor of 4 x 4 m with the lanes of a race.")
        files |= sdf.material_files(folder, "course", canvas.png())
    return files
