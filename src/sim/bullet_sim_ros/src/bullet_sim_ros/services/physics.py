"""Step, update rate and gravity; ODE's parameters that Bullet does not use are only stored."""

from gazebo_msgs.msg import ODEPhysics
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import Vector3

from bullet_sim.errors import prefixed
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, service
from bullet_sim_ros.services.physics_reconfigure import FIELDS
from bullet_sim_ros.simulation import Simulation

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
