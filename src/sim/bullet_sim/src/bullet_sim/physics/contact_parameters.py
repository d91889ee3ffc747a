"""A link's contact parameters in the engine's terms, as close as possible to ODE's."""

import math

from bullet_sim.description import Collision, Surface
from bullet_sim.pose import Pose, conjugate, multiply, rotate

SOFTEST, HARDEST = 1.0, 1e5  # N/m between which kp is used; harder ones are as below
# Rigid contacts do not determine which of four carries how much: robots on two wheels and two
# casters stood with spinning wheels. ODE lets contacts sink in by its surface layer of 1 mm (ODE
# manual, dWorldSetContactSurfaceLayer; the depth is SDF's contact_surface_layer). Here a body's
# weight on three of them sinks in by 0.05 mm: if deeper, contacts that the engine keeps behind a
# wheel's lowest point push a robot without motors (0.3 m in 5 s at 0.5 mm).
SINK, SHARING = 5e-5, 3  # m, contacts
LEAST_STIFFNESS = 2e5  # N/m
DAMPING_RATIO = 2.0  # of critical; at 1 free wheels begin to roll, too
GRAVITY = 9.81  # m/s^2, for the assumed weight
# A thing that bounces is some mm deep when it is first found to touch. With the engine's own
# correction of that, it jumped to 1.3 times the height that it fell from.
BOUNCING = 10.0  # times as stiff as contacts that give way
EMERGING = 0.5  # s, in which most of the depth is corrected
UNYIELDING = 1e9  # N/m
ALIGNED = 0.97  # cosine: fdir1 has to lie along one of the engine's axes


def contact_values(collision: Collision, fixed: bool, com: Pose, mass: float
                   ) -> dict[str, object]:
    """Arguments of changeDynamics; `com`: principal axes of the link, the engine's for friction.

    `mass` (kg) is that of the whole body.

    The engine multiplies two frictions where Gazebo's ODEPhysics::Collide takes the smaller one:
    static bodies have 1 at most, so that the product is the moving part's own coefficient. Two
    restitutions are multiplied too, hence the roots: two equal values give that value.
    """
    surface = collision.surface
    return {
        **_friction(surface, collision.pose, com, fixed),
        "restitution": math.sqrt(surface.restitution),
        "rollingFriction": 0.0, "spinningFriction": 0.0,
        **hardness(surface, fixed, mass),
    }


def hardness(surface: Surface, fixed: bool, mass: float) -> dict[str, float]:
    """Stiffness (N/m) and damping (N s/m) of a body of `mass` (kg) in contacts, if any.

    If `kp` does not give them, they follow from the weight; static bodies are rigid.
    """
    if SOFTEST <= surface.kp <= HARDEST:
        return {"contactStiffness": surface.kp, "contactDamping": max(surface.kd, 0.0)}
    if fixed:
        return {}
    return _bouncing(mass) if surface.restitution else _giving_way(mass)


def _giving_way(mass: float) -> dict[str, float]:
    stiffness = max(LEAST_STIFFNESS, mass * GRAVITY / (SHARING * SINK))
    critical = 2.0 * math.sqrt(stiffness * mass / SHARING)
    return {"contactStiffness": stiffness, "contactDamping": DAMPING_RATIO * critical}


def _bouncing(mass: float) -> dict[str, float]:
    """Stiff, and with a correcting velocity too small to add to a bounce."""
    stiffness = BOUNCING * _giving_way(mass)["contactStiffness"]
    return {"contactStiffness": stiffness, "contactDamping": stiffness * EMERGING}


def corrected_part(values: dict[str, float], timestep: float) -> float:
    """Part of its depth that a contact with these values corrects in each step (s)."""
    pushed = values["contactStiffness"] * timestep
    return pushed / (pushed + values["contactDamping"])


def correcting_velocity_values(part: float, timestep: float) -> dict[str, float]:
    """Stiffness and damping of a contact that corrects `part` of its depth in each step (s)."""
    return {"contactStiffness": UNYIELDING,
            "contactDamping": UNYIELDING * timestep * (1.0 / part - 1.0)}


def _friction(surface: Surface, placed: Pose, com: Pose, fixed: bool) -> dict[str, object]:
    """`mu` along fdir1 and `mu2` across it; without fdir1 `mu` applies in all directions."""
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
