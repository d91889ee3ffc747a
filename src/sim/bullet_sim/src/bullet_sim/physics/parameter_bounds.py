"""Limits of physics parameters: beyond them a step takes too long, or its result is useless."""

import logging
import math
from collections.abc import Iterable
from dataclasses import replace

from bullet_sim.description import PhysicsDescription
from bullet_sim.errors import SimulationError
from bullet_sim.physics.assembly import MOST_LINKS, Tree

log = logging.getLogger(__name__)

SHORTEST_STEP = 1e-5  # s; with shorter ones 10 ms of time, and thus an answer, take a second
LONGEST_STEP = 0.1  # s; with longer ones bodies pass through each other
MOST_ITERATIONS = 10_000  # per step; the limit in gazebo_ros' cfg/Physics.cfg
HIGHEST_RATE = 1e6  # Hz
COARSEST = 1e-2  # m^2/s^2, of the solver's residual: 0.1 m/s
# Fields of PhysicsDescription without a parameter in the engine, and their names in messages; none
# may be negative.
KEPT = {"sor": "sor_pgs_w", "cfm": "cfm", "erp": "erp",
        "contact_surface_layer": "contact_surface_layer",
        "contact_max_correcting_vel": "contact_max_correcting_vel"}
# PyBullet keeps 128 positions of a body, 7 of them its base's, and reports no more (measured).
MOST_POSITIONS = 121
BALL_POSITIONS = 4  # of a ball joint: a quaternion


def check_physics(physics: PhysicsDescription) -> None:
    """Raise a SimulationError that names the value and its limits."""
    if not SHORTEST_STEP <= physics.max_step_size <= LONGEST_STEP:
        raise SimulationError(f"a time step of {physics.max_step_size:g} s is not possible; "
                              f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} is")
    if not 0 <= physics.real_time_update_rate <= HIGHEST_RATE:
        raise SimulationError(f"an update rate of {physics.real_time_update_rate:g} Hz is not "
                              f"possible; 0 (no limit) to {HIGHEST_RATE:g} is")
    if not 0 <= physics.iterations <= MOST_ITERATIONS:
        raise SimulationError(f"{physics.iterations} solver iterations per step are not possible; "
                              f"0 to {MOST_ITERATIONS} are")
    if physics.residual is not None and not 0.0 < physics.residual <= COARSEST:
        raise SimulationError(f"a residual of {physics.residual:g} is not possible; more than "
                              f"0, up to {COARSEST:g} is")


def possible_physics(physics: PhysicsDescription) -> PhysicsDescription:
    """A world file's parameters; the default, with an error line, for those beyond the limits."""
    usual = PhysicsDescription()
    for field in ("max_step_size", "real_time_update_rate", "iterations", "residual"):
        asked, default = getattr(physics, field), getattr(usual, field)
        try:
            check_physics(replace(usual, **{field: asked}))
        except SimulationError as error:
            log.error("<physics>: %s; %s is used instead", error,
                      "the usual one" if default is None else f"{default:g}")
            physics = replace(physics, **{field: default})
    return physics


def check_kept(before: PhysicsDescription, after: PhysicsDescription) -> None:
    """SimulationError that names a value of KEPT that was changed to a negative or not finite one.

    Values from a world file are not checked: they do no harm.
    """
    for field, name in KEPT.items():
        value = getattr(after, field)
        if value != getattr(before, field) and not 0 <= value < math.inf:
            raise SimulationError(f"{name} is {value:g}; it must be finite and not below 0")


def check_trees(model: str, trees: Iterable[Tree]) -> None:
    """SimulationError if a model is larger than the engine can hold in one piece."""
    for tree in trees:
        balls = sum(link.joint is not None and link.joint.type == "ball" for link in tree.links)
        moving = sum(link.joint is not None for link in tree.links)
        if moving + (BALL_POSITIONS - 1) * balls > MOST_POSITIONS:
            counting = f" ({balls} balls among them, which count {BALL_POSITIONS} times)"
            raise SimulationError(
                f"model {model} has {moving} moving joints in one piece"
                f"{counting if balls else ''}; the engine takes at most {MOST_POSITIONS}")
        if len(tree.links) > MOST_LINKS:
            raise SimulationError(
                f"model {model} has {len(tree.links)} links in one piece, including those of "
                f"fixed joints and of collisions with different surfaces; the engine takes at "
                f"most {MOST_LINKS}")
