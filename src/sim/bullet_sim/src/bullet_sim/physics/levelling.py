"""Lets casters be a little lower than the wheels, as ODE's surface layer does.

ODE lets contacts be that are no deeper than the layer (ODE manual, dWorldSetContactSurfaceLayer),
so that casters which are up to 1 mm too low do not lift the wheels. The engine's contacts push from
the first: casters before and behind the wheels would carry the robot, and these spin. Hence the
casters' shapes are put up a little.
"""

from dataclasses import replace

import numpy as np

from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.supports import Support, find_supports
from bullet_sim.physics.tyres import resized
from bullet_sim.pose import Pose, conjugate, rotate

THICKEST = 1e-3  # m; of a thicker layer no more than this counts
CLEARANCE = 2e-4  # m, of levelled casters above the wheels' ground: wheels sink in by less
ROUNDING = 1e-6  # m
GRIP = 0.5  # part of the greatest friction of all wheels: what has less is a caster


def levelled(tree: Tree, layer: float) -> Tree:
    """The tree, no caster being lower than the wheels by up to `layer` (m).

    Only where casters before and behind the wheels would carry instead of them.
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
    """Whether it is no lower than the wheels by more than is let be, and hardly higher."""
    deepest = min(max(layer, support.collision.surface.min_depth), THICKEST)
    return ground - deepest - ROUNDING < support.bottom < ground + CLEARANCE


def _lifted(wheels: list[Support], casters: list[Support]) -> bool:
    """Whether casters stand before all wheels and behind them."""
    if not casters:
        return False
    own, others = (np.concatenate([support.feet @ wheels[0].axle.ahead for support in some])
                   for some in (wheels, casters))
    return bool(others.max() > own.max() and others.min() < own.min())


def _raised(link: PhysicsLink, caster: Support, bottom: float) -> PhysicsLink:
    """The link with that caster's bottom at another height (m); what rolls gets smaller."""
    height = bottom - caster.bottom
    if caster.axle:
        changed = resized(caster.collision, height, caster.axle.radius, caster.axle.centre)
    else:
        up = rotate(conjugate(caster.pose.orientation), (0.0, 0.0, height))
        changed = replace(caster.collision, pose=caster.collision.pose * Pose(up))
    collisions = list(link.collisions)
    collisions[caster.place] = changed
    return replace(link, collisions=collisions)
