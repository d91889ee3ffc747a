"""Enlarges the shapes of a model: what the scale tool of Gazebo's window leaves in a `<state>`."""

from dataclasses import replace

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Heightmap,
    Mesh,
    ModelDescription,
    Polyline,
    Sphere,
    Visual,
)
from bullet_sim.pose import Vector3


def scaled_model(model: ModelDescription, factors: Vector3) -> ModelDescription:
    """Shapes grow about their own middles, as Gazebo has it; no pose and no mass changes."""
    if factors == (1.0, 1.0, 1.0):
        return model
    return replace(model, links=tuple(
        replace(
            link,
            visuals=tuple(_scaled_part(visual, factors) for visual in link.visuals),
            collisions=tuple(_scaled_part(collision, factors) for collision in link.collisions),
        )
        for link in model.links
    ))


def _scaled_part(part: Visual | Collision, factors: Vector3) -> Visual | Collision:
    return replace(part, geometry=scaled(part.geometry, factors))


def scaled(shape: Geometry, factors: Vector3) -> Geometry:
    """A shape along its own axes; round ones stay round, by their greatest factor."""
    x, y, z = factors
    match shape:
        case Box(size):
            return Box(_product(size, factors))
        case Cylinder(radius, length):
            return Cylinder(radius * max(x, y), length * z)
        case Sphere(radius):
            return Sphere(radius * max(factors))
        case Mesh(scale=scale):
            return replace(shape, scale=_product(scale, factors))
        case Heightmap(size=size):
            return replace(shape, size=_product(size, factors))
        case Polyline(outlines, height):
            return Polyline(
                tuple(tuple((px * x, py * y) for px, py in outline) for outline in outlines),
                height * z)
    return shape


def _product(lengths: Vector3, factors: Vector3) -> Vector3:
    return tuple(length * factor for length, factor in zip(lengths, factors, strict=True))
