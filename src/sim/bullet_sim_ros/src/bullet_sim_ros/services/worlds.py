"""The world as a whole: its properties and those of its models, pause, step, reset."""

from collections.abc import Callable
from functools import partial

from gazebo_msgs.srv import GetModelProperties, GetWorldProperties
from std_srvs.srv import Empty

from bullet_sim_ros import names
from bullet_sim_ros.loop import advance
from bullet_sim_ros.services.answers import done, service
from bullet_sim_ros.services.lookup import find_part
from bullet_sim_ros.simulation import Simulation


def _register(name: str, act: Callable[[Simulation], None]) -> None:
    """Register a service of type std_srvs/Empty."""
    service(name, Empty)(lambda simulation, _request, _response: act(simulation))


def _set_paused(simulation: Simulation, paused: bool) -> None:
    simulation.world.paused = paused


def _step(simulation: Simulation) -> None:
    """Take one step and run the tasks due then; afterwards pause and publish /clock."""
    simulation.world.paused = False
    try:
        advance(simulation)
    finally:
        simulation.world.paused = True
    simulation.publish_clock()


_register(names.PAUSE_PHYSICS, partial(_set_paused, paused=True))
_register(names.UNPAUSE_PHYSICS, partial(_set_paused, paused=False))
_register(names.STEP_PHYSICS, _step)
_register(names.RESET_WORLD, lambda simulation: simulation.world.reset_models())
_register(names.RESET_SIMULATION, Simulation.reset)


@service(names.GET_WORLD_PROPERTIES, GetWorldProperties)
def get_world_properties(simulation: Simulation, _request, response) -> None:
    """Time and the models' names, in the order in which they were added."""
    response.sim_time = simulation.world.time
    response.model_names = list(simulation.world.models)
    response.rendering_enabled = True
    done(response, "GetWorldProperties: got properties")


@service(names.GET_MODEL_PROPERTIES, GetModelProperties)
def get_model_properties(simulation: Simulation, request, response) -> None:
    """The unscoped names of a model's parts. ServiceError without such a model."""
    part = find_part(simulation.world, request.model_name,
                     "GetModelProperties: model does not exist")
    response.parent_model_name = part.parent_name
    response.body_names = [part.unscoped(link.name) for link in part.links()]
    response.geom_names = [collision.name for link in part.links()
                           for collision in link.description.collisions]
    response.joint_names = [part.unscoped(joint.name) for joint in part.joints()]
    response.child_model_names = part.child_names
    response.is_static = part.model.static
    done(response, "GetModelProperties: got properties")
