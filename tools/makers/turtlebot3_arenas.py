"""The plain worlds and their models: square and plaza that robots learn in, and the house."""

from __future__ import annotations

import sdf
from sdf import DARK, GREY, WHITE, Part, box, cylinder

THICK, HIGH = 0.15, 0.5  # m, of every wall
PLAZA_WALLS = (  # x, y of the middle, yaw; each 1 m long
    (1.0, 1.0, 0.0), (-1.5, 0.0, 1.5708), (1.2, -0.9, 1.5708), (-0.6, -1.7, 0.0),
    (-1.2, 1.85, 1.5708),
)


CORNERS = ((0.6, 0.6), (0.6, -0.6), (-0.6, 0.6), (-0.6, -0.6))  # m, of stages 2 and 3
CORNER_INERTIAL = ("<inertial><pose>0 0 0.25 0 0 0</pose><mass>20</mass><inertia><ixx>8</ixx>"
                   "<iyy>8</iyy><izz>15</izz></inertia></inertial>")  # four columns, as one body
TUNNEL = ((-1.66, -2.465), (-2.407, -2.541), (-2.182, -1.754))  # m, upstream's three columns
RED = (1.0, 0.0, 0.0)
WALL_THICK, WALL_HIGH = 0.15, 2.5  # m
EAST, NORTH = 7.6, 5.2  # m, middles of the outer walls; west and south lie opposite
DOOR = 1.0  # m, width
WOOD, CLOTH = (0.55, 0.38, 0.2), (0.25, 0.3, 0.45)
METAL, GREEN = (0.7, 0.72, 0.75), (0.2, 0.45, 0.2)
# Along x: y, from x, to x, middles of the doors. Along y: x, from y, to y, middles of the doors.
ALONG_X = (
    (NORTH, -EAST, EAST, ()), (-NORTH, -EAST, EAST, (-2.5,)),
    (1.5, -EAST, -4.5, (-6.0,)), (1.5, 4.5, EAST, (6.0,)), (-0.5, -4.5, 4.5, (-2.5, 2.5)),
)
ALONG_Y = (
    (-EAST, -NORTH, NORTH, ()), (EAST, -NORTH, NORTH, ()),
    (-4.5, -NORTH, NORTH, (-2.0, 3.0)), (4.5, -NORTH, NORTH, (-2.0, 3.0)),
    (0.0, -NORTH, -0.5, (-3.0,)),
)
PHYSICS = """  <physics type="ode">
    <real_time_update_rate>1000.0</real_time_update_rate>
    <max_step_size>0.001</max_step_size>
    <real_time_factor>1</real_time_factor>
    <ode>
      <solver>
        <type>quick</type>
        <iters>150</iters>
        <precon_iters>0</precon_iters>
        <sor>1.400000</sor>
        <use_dynamic_moi_rescaling>1</use_dynamic_moi_rescaling>
      </solver>
      <constraints>
        <cfm>0.00001</cfm>
        <erp>0.2</erp>
        <contact_max_correcting_vel>2000.000000</contact_max_correcting_vel>
        <contact_surface_layer>0.01000</contact_surface_layer>
      </constraints>
    </ode>
  </physics>"""
STAGE_SCENE = """  <scene>
    <ambient>0.4 0.4 0.4 1</ambient>
    <background>0.7 0.7 0.7 1</background>
    <shadows>0</shadows>
  </scene>"""
UNSHADED = "  <scene><shadows>0</shadows></scene>"


def rim(side: float) -> list[Part]:
    """Four walls round a square whose outer faces are `side` m apart."""
    middle = (side - THICK) / 2
    places = (("north", 0, middle, 0.0), ("south", 0, -middle, 0.0),
              ("east", middle, 0, 1.5708), ("west", -middle, 0, 1.5708))
    return [Part(name, box(side, THICK, HIGH), (x, y, HIGH / 2, 0, 0, yaw), WHITE)
            for name, x, y, yaw in places]


def square() -> dict[str, bytes]:
    """4 x 4 m."""
    name = "turtlebot3_square"
    text = sdf.model(name, [sdf.link("walls", rim(4.0))])
    return sdf.model_files(name, text, "Four walls, 4 x 4 m.")


def plaza() -> dict[str, bytes]:
    """5 x 5 m with five walls of 1 m in it."""
    name = "turtlebot3_plaza"
    inner = [Part(f"inner_{i}", box(1.0, THICK, HIGH), (x, y, HIGH / 2, 0, 0, yaw), WHITE)
             for i, (x, y, yaw) in enumerate(PLAZA_WALLS, 1)]
    text = sdf.model(name, [sdf.link("walls", rim(5.0) + inner)])
    return sdf.model_files(name, text, "Walls round 5 x 5 m, and five of 1 m within.")


def columns(name: str, static: int) -> str:
    """Four columns in one link."""
    parts = [Part(f"column_{i}", cylinder(0.15, 0.5), (x, y, 0.25), WHITE)
             for i, (x, y) in enumerate(CORNERS, 1)]
    mass = "" if static else CORNER_INERTIAL
    return sdf.model(name, [sdf.link("link", parts, mass=mass)], static=static)


def goal(name: str) -> str:
    """A red square on the floor, which a robot drives over: what a learning robot looks for."""
    part = Part(name, box(0.5, 0.5, 0.001), (0, 0, 0.0005), RED, solid=False)
    return sdf.model(name, [sdf.link(name, [part])])


def put_in() -> dict[str, bytes]:
    """The models that scripts spawn by upstream's paths, or that old worlds include."""
    floor = Part("ground", box(10, 10, 0.01), (0, 0, -0.1), DARK)
    tunnel = [Part(f"column_{i}", cylinder(0.1, 0.5), (x, y, 0.25), GREY)
              for i, (x, y) in enumerate(TUNNEL, 1)]
    made = {
        "turtlebot3_square/goal_box": (goal("goal_box"), "A red square of 0.5 m on the floor."),
        "turtlebot3_goalbox": (goal("turtlebot3_goalbox"), "A red square of 0.5 m on the floor."),
        "turtlebot3_obstacle": (columns("turtlebot3_obstacle", static=1), "Stage 2's columns."),
        "turtlebot3_autorace/ground": (
            sdf.model("ground", [sdf.link("ground", [floor])]), "A dark floor, 10 x 10 m."),
        "turtlebot3_autorace/tunnel_obstacles": (
            sdf.model("tunnel_obstacles", [sdf.link("link", tunnel)]),
            "Three columns in the tunnel."),
    }
    return {path: data for folder, (text, description) in made.items()
            for path, data in sdf.model_files(folder, text, description).items()}


def arenas() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    return {**square(), **plaza(), **put_in()}


def pieces(start: float, end: float, doors: tuple[float, ...]) -> list[tuple[float, float]]:
    """Middle and length of what the doors leave of a wall."""
    edges = [start, *(edge for door in doors for edge in (door - DOOR / 2, door + DOOR / 2)), end]
    return [((a + b) / 2, b - a) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def walls() -> list[Part]:
    parts = []
    for y, start, end, doors in ALONG_X:
        parts += [(box(length + WALL_THICK, WALL_THICK, WALL_HIGH), (middle, y, WALL_HIGH / 2))
                  for middle, length in pieces(start, end, doors)]
    for x, start, end, doors in ALONG_Y:
        parts += [(box(WALL_THICK, length - WALL_THICK, WALL_HIGH), (x, middle, WALL_HIGH / 2))
                  for middle, length in pieces(start, end, doors)]
    return [Part(f"wall_{i}", shape, place, WHITE) for i, (shape, place) in enumerate(parts, 1)]


def table(name: str, x: float, y: float, long: float, wide: float, high: float) -> list[Part]:
    """A top on four legs."""
    leg = high - 0.04
    legs = [Part(f"{name}_leg_{i}", cylinder(0.025, leg), (x + sx * (long / 2 - 0.06),
                 y + sy * (wide / 2 - 0.06), leg / 2), WOOD)
            for i, (sx, sy) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1)), 1)]
    return [Part(f"{name}_top", box(long, wide, 0.04), (x, y, high - 0.02), WOOD), *legs]


def block(name: str, x: float, y: float, size: tuple[float, float, float], colour) -> Part:
    """A piece of furniture that stands on the floor."""
    return Part(name, box(*size), (x, y, size[2] / 2), colour)


def living_room() -> list[Part]:
    return [*table("dining_table", 2.5, 3.2, 1.6, 0.9, 0.75),
            *(part for i, (x, y) in enumerate(((2.0, 2.5), (3.0, 2.5), (2.0, 3.9), (3.0, 3.9)), 1)
              for part in table(f"chair_{i}", x, y, 0.4, 0.4, 0.45)),
            block("sofa_seat", -2.6, 4.6, (2.0, 0.8, 0.4), CLOTH),
            block("sofa_back", -2.6, 4.95, (2.0, 0.2, 0.85), CLOTH),
            *table("low_table", -2.6, 3.2, 1.0, 0.5, 0.4),
            block("shelf", 4.2, 0.6, (0.35, 1.4, 1.8), WOOD),
            Part("plant_pot", cylinder(0.2, 0.4), (-4.0, 0.1, 0.2), GREEN)]


def bedrooms() -> list[Part]:
    return [block("bed_west", -6.5, 4.0, (1.6, 2.0, 0.5), CLOTH),
            block("wardrobe_west", -4.9, 4.6, (0.5, 0.9, 2.0), WOOD),
            block("bed_east", 6.5, 4.0, (1.6, 2.0, 0.5), CLOTH),
            block("wardrobe_east", 4.9, 4.6, (0.5, 0.9, 2.0), WOOD),
            *table("desk_west", -6.8, -4.6, 1.3, 0.7, 0.75),
            block("shelf_west", -4.8, -4.2, (0.35, 1.4, 1.8), WOOD)]


def kitchen_and_bath() -> list[Part]:
    return [block("counter", 2.3, -4.8, (3.6, 0.6, 0.9), METAL),
            block("fridge", 4.1, -4.75, (0.6, 0.7, 1.8), WHITE),
            *table("kitchen_table", 2.6, -2.4, 0.9, 0.9, 0.75),
            block("bath", 6.9, -4.3, (0.8, 1.6, 0.55), WHITE),
            Part("boiler", cylinder(0.3, 1.5), (5.0, -4.7, 0.75), METAL),
            Part("bin", cylinder(0.15, 0.4), (0.5, -4.6, 0.2), METAL),
            block("coat_stand", -0.5, -4.6, (0.6, 0.4, 1.8), WOOD)]


def house() -> dict[str, bytes]:
    """Path below `models/` -> bytes."""
    name = "turtlebot3_house"
    furniture = living_room() + bedrooms() + kitchen_and_bath()
    text = sdf.model(name, [sdf.link("walls", walls()), sdf.link("furniture", furniture)])
    return sdf.model_files(name, text, "Seven rooms with doors and plain furniture.")


def include(uri: str, place: sdf.Numbers = sdf.ORIGIN) -> str:
    return f"  <include><uri>model://{uri}</uri>{sdf.pose(place)}</include>"


def world(*parts: str) -> bytes:
    """A world file; each part is one or more elements."""
    body = "\n".join(["<world name=\"default\">", *parts, PHYSICS, "</world>"])
    return sdf.document(body).encode()


def pillar(name: str, x: float, y: float) -> str:
    part = Part("obstacle", cylinder(0.12, 0.25), (0, 0, 0.125), WHITE)
    return sdf.model(name, [sdf.link("link", [part])], (x, y, 0.0))


def worlds() -> dict[str, bytes]:
    """File name below `worlds/` -> bytes."""
    ground = include("ground_plane"), include("sun")
    square, plaza = include("turtlebot3_square"), include("turtlebot3_plaza")
    made = {
        "empty": world(UNSHADED, *ground),
        "turtlebot3_world": world(UNSHADED, *ground, include("turtlebot3_world")),
        "turtlebot3_house": world(UNSHADED, *ground, include("turtlebot3_house")),
        "turtlebot3_stage_1": world(STAGE_SCENE, *ground, square),
        "turtlebot3_stage_2": world(STAGE_SCENE, *ground, square, columns("obstacle", static=1)),
        "turtlebot3_stage_3": world(STAGE_SCENE, *ground, square, columns("obstacle", static=0)),
        "turtlebot3_stage_4": world(STAGE_SCENE, *ground, plaza, pillar("obstacle_1", 2.0, 2.0),
                                    pillar("obstacle_2", -2.0, -2.0)),
    }
    return {f"{name}.world": text for name, text in made.items()}
