"""Reads `<actor>`: a figure that walks a trajectory, regardless of obstacles.

It is a model whose only collisions are those of its own links: cameras see it,
ray sensors do not. Skin and animation files are not read; a simple figure represents the person.
"""

from xml.etree.ElementTree import Element

from bullet_sim import description
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import all_that_can
from bullet_sim.formats.sdf.frames import Frames, add_model_frames
from bullet_sim.formats.sdf.link import read_link
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import amount, flag, number, pose
from bullet_sim.pose import Pose

BODY_RADIUS, BODY_HEIGHT, HEAD_RADIUS = 0.2, 1.45, 0.13  # m, of an adult
CLOTHES = description.Material(ambient=(0.2, 0.3, 0.45, 1.0), diffuse=(0.2, 0.3, 0.45, 1.0))
SKIN = description.Material(ambient=(0.8, 0.6, 0.5, 1.0), diffuse=(0.8, 0.6, 0.5, 1.0))


def read_actor(element: Element, source: Source) -> description.ModelDescription:
    """An actor as a moving model, at the pose where its script begins.

    FormatError if it has no name.
    """
    name = element.get("name", "")
    if not name:
        raise FormatError("an <actor> has no name")
    where = f"actor {name!r}"
    frames = Frames(source, name)
    add_model_frames(frames, element, where)
    links = all_that_can(read_link, element.findall("link"), source, where, frames)
    if element.find("skin") is not None or not links:
        scale = amount(element, "skin/scale", 1.0, f"{where} <skin>")
        links.insert(0, _figure(f"{name}_pose", scale or 1.0))
    trajectory = _trajectory(element.find("script"), where)
    return description.ModelDescription(
        name=name,
        pose=trajectory.waypoints[0][1] if trajectory else pose(element, where),
        static=True,
        links=tuple(links),
        plugins=read_plugins(element),
        trajectory=trajectory,
    )


def _figure(link: str, scale: float) -> description.LinkDescription:
    """A standing figure with its feet at z = 0."""
    body = description.Cylinder(BODY_RADIUS * scale, BODY_HEIGHT * scale)
    head = description.Sphere(HEAD_RADIUS * scale)
    top = (BODY_HEIGHT + HEAD_RADIUS) * scale
    return description.LinkDescription(link, visuals=(
        description.Visual("body", body, Pose((0.0, 0.0, BODY_HEIGHT * scale / 2)), CLOTHES),
        description.Visual("head", head, Pose((0.0, 0.0, top)), SKIN),
    ))


def _trajectory(script: Element | None, where: str) -> description.Trajectory | None:
    """All trajectories of a script, one after another in the order of their ids."""
    if script is None:
        return None
    where = f"{where} <script>"
    waypoints: list[tuple[float, Pose]] = []
    begin = 0.0
    for part in sorted(script.findall("trajectory"), key=_rank):
        timed = [(amount(waypoint, "time", 0.0, f"{where} <waypoint>"),
                  pose(waypoint, f"{where} <waypoint>"))
                 for waypoint in part.findall("waypoint")]
        waypoints += [(begin + time, place) for time, place in sorted(timed, key=lambda w: w[0])]
        begin = waypoints[-1][0] if waypoints else 0.0
    if not waypoints:
        return None
    return description.Trajectory(
        waypoints=tuple(waypoints),
        loop=flag(script, "loop", True),
        delay_start=number(script, "delay_start", 0.0, where),
        auto_start=flag(script, "auto_start", True),
    )


def _rank(trajectory: Element) -> float:
    try:
        return float(trajectory.get("id", "0"))
    except ValueError:
        return 0.0
