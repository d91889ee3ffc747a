"""Physics by service and by dynamic_reconfigure: step, update rate, gravity, ODE's parameters.

Those of ODE's that Bullet does not use are only stored. Names and bounds of dynamic_reconfigure are
those of gazebo_ros/cfg/Physics.cfg.
"""

from collections.abc import Callable
from typing import Any

import rospy
from gazebo_msgs.msg import ODEPhysics
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import Vector3

from bullet_sim.description import PhysicsDescription, WorldDescription
from bullet_sim.errors import SimulationError, prefixed
from bullet_sim_ros import convert, names
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.mailbox import Closed
from bullet_sim_ros.reconfigure_server import Value, ValueServer
from bullet_sim_ros.services.answers import ServiceError, done, service
from bullet_sim_ros.simulation import Simulation

FIELDS = {  # name: field of PhysicsDescription, least, greatest, description
    "time_step": ("max_step_size", 0.0, 10.0, "Step, s"),
    "max_update_rate": ("real_time_update_rate", 0.0, 1000.0, "Steps a second of wall time, Hz"),
    "auto_disable_bodies": ("auto_disable_bodies", False, True, "Bodies at rest may sleep"),
    "sor_pgs_precon_iters": ("precon_iterations", 0, 10000, "Iterations before the others"),
    "sor_pgs_iters": ("iterations", 0, 10000, "Iterations of the solver"),
    "sor_pgs_w": ("sor", 0.0, 5.0, "Over-relaxation"),
    "sor_pgs_rms_error_tol": (None, -1.0, 10000.0, "Kept only"),
    "cfm": ("cfm", 0.0, 10.0, "Constraint force mixing"),
    "erp": ("erp", 0.0, 10.0, "Error reduction"),
    "contact_surface_layer": ("contact_surface_layer", 0.0, 10.0, "Depth that is let be, m"),
    "contact_max_correcting_vel": ("contact_max_correcting_vel", 0.0, 1e7, "m/s"),
    "max_contacts": ("max_contacts", 0, 10_000_000, "Of two bodies"),
}
GRAVITY = ("gravity_x", "gravity_y", "gravity_z")
GRAVITY_LIMIT = 100.0  # m/s^2, in both directions
UNUSED = -1.0  # the value of parameters that the world does not have
# Field of gazebo_msgs/ODEPhysics, of the same name in Physics.cfg: field of PhysicsDescription.
ODE = {name: FIELDS[name][0] for name in ODEPhysics.__slots__ if FIELDS[name][0]}


@service(names.GET_PHYSICS_PROPERTIES, GetPhysicsProperties)
def get_physics_properties(simulation: Simulation, _request, response) -> None:
    """The present values; `sor_pgs_rms_error_tol` is 0, as getPhysicsProperties never sets it."""
    description = simulation.world.description
    physics = description.physics
    response.time_step = physics.max_step_size
    response.max_update_rate = physics.real_time_update_rate
    response.pause = simulation.world.paused
    response.gravity = Vector3(*description.gravity)
    for field, ours in ODE.items():
        setattr(response.ode_config, field, getattr(physics, ours))
    done(response, "GetPhysicsProperties: got properties")


@service(names.SET_PHYSICS_PROPERTIES, SetPhysicsProperties)
def set_physics_properties(simulation: Simulation, request, response) -> None:
    """Writes every field, so get first, then set. ServiceError if one is impossible."""
    if not convert.is_sane(request.gravity):
        raise ServiceError("SetPhysicsProperties: gravity is not finite")
    ode = {ours: getattr(request.ode_config, field) for field, ours in ODE.items()}
    with prefixed("SetPhysicsProperties:", ServiceError):
        simulation.configure_physics(
            max_step_size=request.time_step, real_time_update_rate=request.max_update_rate,
            gravity=convert.triple(request.gravity), **ode)
    done(response, "physics engine updated")


class PhysicsReconfigure:
    """Writes only changed values, so that those set by set_physics_properties meanwhile stay.

    physicsReconfigureCallback writes all values, including those that are out of date.
    """

    def __init__(self, simulation: Simulation):
        self._simulation = simulation
        self._last: dict[str, Any] = {}
        ValueServer("", _present(simulation.world.description), self._change)
        rospy.loginfo("Physics dynamic reconfigure ready.")

    def _change(self, values: dict[str, Any]) -> None:
        """Called in a ROS thread; the first time with the world's own values."""
        changed = {name: value for name, value in values.items()
                   if value != self._last.get(name, value)}
        if changed:
            self._in_loop(lambda: self._write(changed))
        self._last = values

    def _in_loop(self, write: Callable[[], None]) -> None:
        try:
            self._simulation.mailbox.call(write, Input(
                rospy.resolve_name(names.SET_PARAMETERS), None, called=True))
        except (SimulationError, Closed) as error:
            rospy.logerr("%s: %s", rospy.resolve_name(names.SET_PARAMETERS), error)
            raise rospy.ServiceException(str(error)) from None

    def _write(self, changed: dict[str, Any]) -> None:
        fields = {FIELDS[name][0]: value for name, value in changed.items()
                  if name in FIELDS and FIELDS[name][0]}
        gravity = self._simulation.world.description.gravity
        fields["gravity"] = tuple(
            changed.get(name, now) for name, now in zip(GRAVITY, gravity, strict=True))
        self._simulation.configure_physics(**fields)


def _present(world: WorldDescription) -> dict[str, Value]:
    values = {name: _value(world.physics, *rest) for name, rest in FIELDS.items()}
    for name, now in zip(GRAVITY, world.gravity, strict=True):
        values[name] = Value(float(now), -GRAVITY_LIMIT, GRAVITY_LIMIT, "m/s^2")
    return values


def _value(physics: PhysicsDescription, field: str | None, least, greatest, about: str) -> Value:
    now = getattr(physics, field) if field else UNUSED
    return Value(type(least)(now), least, greatest, about)
