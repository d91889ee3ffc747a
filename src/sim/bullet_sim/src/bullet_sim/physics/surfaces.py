"""A link's contact parameters in the engine's terms, as near to ODE's as these come."""

from __future__ import annotations

import math

from bullet_sim.description import Collision, Surface
from bullet_sim.pose import Pose, conjugate, multiply, rotate

SOFTEST, HARDEST = 1.0, 1e5  # N/m between which kp is taken; harder ones give way unseen
ALIGNED = 0.97  # cosine: fdir1 has to lie along one of the engine's axes


def contact_values(collision: Collision, fixed: bool, com: Pose) -> dict[str, object]:
    """Arguments of changeDynamics; `com` are the link's principal axes, which friction is told in.

    The engine multiplies two frictions where ODE takes the smaller one: what never moves counts
    as 1 at most, so that the product is the moving part's own coefficient. Two restitutions are
    multiplied too, hence the roots: two alike come out as themselves.
    """
    surface = collision.surface
    values: dict[str, object] = {
        **_friction(surface, collision.pose, com, fixed),
        "restitution": math.sqrt(surface.restitution),
        "rollingFriction": 0.0, "spinningFriction": 0.0,
    }
    if surface.restitution:
        # Else the engine slows down what is about to touch, and it would bounce half as high.
        values["contactProcessingThreshold"] = 0.0
    if SOFTEST <= surface.kp <= HARDEST:
        values["contactStiffness"] = surface.kp
        values["contactDamping"] = max(surface.kd, 0.0)
    return values


def _friction(surface: Surface, placed: Pose, com: Pose, fixed: bool) -> dict[str, object]:
    """`mu` along fdir1 and `mu2` across it; without fdir1 `mu` counts in all directions."""
    along, across = (min(mu, 1.0) if fixed else mu for mu in (surface.mu, surface.mu2))
    axis = _engine_axis(surface, placed, com)
    greatest = max(along, across)
    if axis is None or along == across or greatest == 0.0:
        return {"lateralFriction": along}
    scale = [across / greatest] * 3
    scale[axis] = along / greatest
    return {"lateralFriction": greatest, "anisotropicFriction": scale}


def _engine_axis(surface: Surface, placed: Pose, com: Pose) -> int | None:
    length = math.hypot(*surface.fdir1)
    if length == 0.0:
        return None
    turn = multiply(conjugate(com.orientation), placed.orientation)
    parts = [abs(part) / length for part in rotate(turn, surface.fdir1)]
    nearest = parts.index(max(parts))
    return nearest if parts[nearest] > ALIGNED else None
