"""Lets casters be a little lower than the wheels, as ODE's surface layer does.

ODE does not correct contacts less deep than the layer (ODE manual, dWorldSetContactSurfaceLayer),
so casters that are up to 1 mm too low do not lift the wheels. The engine's contacts push from the
beginning: casters before and behind the wheels would carry the robot, and the wheels would spin.
Hence the casters' shapes are raised a little.
"""

from dataclasses import replace

import numpy as np

from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.supports import Support, find_supports
from bullet_sim.physics.tyres import resized
from bullet_sim.pose import Pose, conjugate, rotate

THICKEST = 1e-3  # m; the maximum of the layer that is used
CLEARANCE = 2e-4  # m, of levelled casters above the wheels' ground: wheels sink in by less
ROUNDING = 1e-6  # m
GRIP = 0.5  # part of the maximum friction of all wheels: casters have less


def levelled(tree: Tree, layer: float) -> Tree:
    """The tree, with casters raised that are lower than the wheels by up to `layer` (m).

    Only if casters before and behind the wheels would carry the robot instead.
    """
    supports = [] if tree.fixed else list(find_supports(tree))
    rolling = [support for support in supports if support.axle and not support.follows]
    grip = max((support.collision.surface.mu for support in rolling), default=0.0)
    wheels = [support for support in rolling if support.collision.surface.mu > GRIP * grip]
    if not wheels:
        return tree
    ground = min(wheel.bottom for wheel in wheels)
    casters = [support for support in supports
               if support not in wheels and _near(support, ground, layer)]
    if not _lifted(wheels, casters):
        return tree
    links = list(tree.links)
    for caster in casters:
        links[caster.link] = _raised(links[caster.link], caster, ground + CLEARANCE)
    return replace(tree, links=links)


def _near(support: Support, ground: float, layer: float) -> bool:
    """Whether it is lower than the wheels by no more than the layer, and hardly higher."""
    deepest = min(max(layer, support.collision.surface.min_depth), THICKEST)
    return ground - deepest - ROUNDING < support.bottom < ground + CLEARANCE


def _lifted(wheels: list[Support], casters: list[Support]) -> bool:
    """Whether there are casters both before and behind all wheels."""
    if not casters:
        return False
    own, others = (np.concatenate([support.feet @ wheels[0].axle.ahead for support in some])
                   for some in (wheels, casters))
    return bool(others.max() > own.max() and others.min() < own.min())


def _raised(link: PhysicsLink, caster: Support, bottom: float) -> PhysicsLink:
    """The link with that caster's bottom at another height (m); one that rolls becomes smaller."""
    height = bottom - caster.bottom
    if caster.axle:
        changed = resized(caster.collision, height, caster.axle.radius, caster.axle.centre)
    else:
        up = rotate(conjugate(caster.pose.orientation), (0.0, 0.0, height))
        changed = replace(caster.collision, pose=caster.collision.pose * Pose(up))
    collisions = list(link.collisions)
    collisions[caster.place] = changed
    return replace(link, collisions=collisions)
