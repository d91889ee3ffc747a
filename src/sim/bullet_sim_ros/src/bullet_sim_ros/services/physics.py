"""Step, update rate and gravity; the numbers of ODE that Bullet has no use for are only kept."""

from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import Vector3

from bullet_sim.errors import SimulationError
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, offer
from bullet_sim_ros.simulation import Simulation

# Fields of gazebo_msgs/ODEPhysics and of our PhysicsDescription.
ODE = {
    "auto_disable_bodies": "auto_disable_bodies",
    "sor_pgs_precon_iters": "precon_iterations",
    "sor_pgs_iters": "iterations",
    "sor_pgs_w": "sor",
    "contact_surface_layer": "contact_surface_layer",
    "contact_max_correcting_vel": "contact_max_correcting_vel",
    "cfm": "cfm",
    "erp": "erp",
    "max_contacts": "max_contacts",
}


def offer_physics_services(simulation: Simulation) -> None:
    """get_physics_properties and set_physics_properties."""
    offer(simulation.mailbox, names.GET_PHYSICS_PROPERTIES, GetPhysicsProperties,
          lambda _request, response: get_physics_properties(simulation, response))
    offer(simulation.mailbox, names.SET_PHYSICS_PROPERTIES, SetPhysicsProperties,
          lambda request, response: set_physics_properties(simulation, request, response))


def get_physics_properties(simulation: Simulation, response) -> None:
    """As the world is now; `sor_pgs_rms_error_tol` stays 0, as upstream's."""
    description = simulation.world.description
    physics = description.physics
    response.time_step = physics.max_step_size
    response.max_update_rate = physics.real_time_update_rate
    response.pause = simulation.world.paused
    response.gravity = Vector3(*description.gravity)
    for field, ours in ODE.items():
        setattr(response.ode_config, field, getattr(physics, ours))
    done(response, "GetPhysicsProperties: got properties")


def set_physics_properties(simulation: Simulation, request, response) -> None:
    """Writes every field, as upstream: get first, then set. ServiceError if one is impossible."""
    if not convert.is_sane(request.gravity):
        raise ServiceError("SetPhysicsProperties: gravity is not finite")
    gravity = (request.gravity.x, request.gravity.y, request.gravity.z)
    ode = {ours: getattr(request.ode_config, field) for field, ours in ODE.items()}
    try:
        simulation.configure_physics(
            max_step_size=request.time_step, real_time_update_rate=request.max_update_rate,
            gravity=gravity, **ode)
    except SimulationError as error:
        raise ServiceError(f"SetPhysicsProperties: {error}") from None
    done(response, "physics engine updated")
