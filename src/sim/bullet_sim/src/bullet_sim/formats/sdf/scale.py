"""Scales the shapes of a model: what the scale tool of Gazebo's client writes into a `<state>`."""

from dataclasses import replace

from bullet_sim import description
from bullet_sim.pose import Vector3


def scaled_model(model: description.ModelDescription,
                 factors: Vector3) -> description.ModelDescription:
    """Shapes grow about their own centres; no pose or mass changes (Gazebo's Link::SetScale)."""
    return replace(model, links=tuple(
        replace(
            link,
            visuals=_scaled_parts(link.visuals, factors),
            collisions=_scaled_parts(link.collisions, factors),
        )
        for link in model.links
    ))


def _scaled_parts(parts: tuple, factors: Vector3) -> tuple:
    return tuple(replace(part, geometry=scaled(part.geometry, factors)) for part in parts)


def scaled(shape: description.Geometry, factors: Vector3) -> description.Geometry:
    """A shape scaled along its own axes; round ones stay round, by their largest factor."""
    x, y, z = factors
    match shape:
        case description.Box(size):
            return description.Box(_product(size, factors))
        case description.Cylinder(radius, length):
            return description.Cylinder(radius * max(x, y), length * z)
        case description.Sphere(radius):
            return description.Sphere(radius * max(factors))
        case description.Mesh(scale=scale):
            return replace(shape, scale=_product(scale, factors))
        case description.Heightmap(size=size):
            return replace(shape, size=_product(size, factors))
        case description.Polyline(outlines, height):
            return description.Polyline(
                tuple(tuple((px * x, py * y) for px, py in outline) for outline in outlines),
                height * z)
    return shape


def _product(lengths: Vector3, factors: Vector3) -> Vector3:
    return tuple(length * factor for length, factor in zip(lengths, factors, strict=True))
