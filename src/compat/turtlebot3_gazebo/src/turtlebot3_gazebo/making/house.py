"""A house of seven rooms with doors and plain furniture, 15.2 x 10.4 m."""

from __future__ import annotations

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.sdf import WHITE, Part, box, cylinder

THICK, HIGH = 0.15, 2.5  # m
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


def pieces(start: float, end: float, doors: tuple[float, ...]) -> list[tuple[float, float]]:
    """Middle and length of what the doors leave of a wall."""
    edges = [start, *(edge for door in doors for edge in (door - DOOR / 2, door + DOOR / 2)), end]
    return [((a + b) / 2, b - a) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def walls() -> list[Part]:
    parts = []
    for y, start, end, doors in ALONG_X:
        parts += [(box(length + THICK, THICK, HIGH), (middle, y, HIGH / 2))
                  for middle, length in pieces(start, end, doors)]
    for x, start, end, doors in ALONG_Y:
        parts += [(box(THICK, length - THICK, HIGH), (x, middle, HIGH / 2))
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
