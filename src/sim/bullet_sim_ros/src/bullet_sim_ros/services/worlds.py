"""The world as a whole: what is in it, pause, reset."""

from gazebo_msgs.srv import GetModelProperties, GetWorldProperties
from std_srvs.srv import Empty

from bullet_sim.world import World
from bullet_sim_ros import names
from bullet_sim_ros.services.answers import done, offer
from bullet_sim_ros.services.lookup import find_part


def offer_world_services(simulation) -> None:
    """What is in the world, pausing and resetting it."""
    world = simulation.world

    def pause(_request, _response):
        world.paused = True

    def unpause(_request, _response):
        world.paused = False

    offer(simulation.mailbox, names.GET_WORLD_PROPERTIES, GetWorldProperties,
          lambda _request, response: get_world_properties(world, response))
    offer(simulation.mailbox, names.GET_MODEL_PROPERTIES, GetModelProperties,
          lambda request, response: get_model_properties(world, request.model_name, response))
    offer(simulation.mailbox, names.PAUSE_PHYSICS, Empty, pause)
    offer(simulation.mailbox, names.UNPAUSE_PHYSICS, Empty, unpause)
    offer(simulation.mailbox, names.STEP_PHYSICS, Empty,
          lambda _request, _response: simulation.step())
    offer(simulation.mailbox, names.RESET_WORLD, Empty,
          lambda _request, _response: world.reset_models())
    offer(simulation.mailbox, names.RESET_SIMULATION, Empty,
          lambda _request, _response: simulation.reset())


def get_world_properties(world: World, response) -> None:
    """Time and the models' names, in the order they came."""
    response.sim_time = world.time
    response.model_names = list(world.models)
    response.rendering_enabled = True
    done(response, "GetWorldProperties: got properties")


def get_model_properties(world: World, name: str, response) -> None:
    """Names of what a model consists of, unscoped."""
    part = find_part(world, name, "GetModelProperties: model does not exist")
    response.parent_model_name = part.parent_name
    response.body_names = [part.unscoped(link.name) for link in part.links()]
    response.geom_names = [collision.name for link in part.links()
                           for collision in link.description.collisions]
    response.joint_names = [part.unscoped(joint.name) for joint in part.joints()]
    response.child_model_names = part.child_names
    response.is_static = part.model.static
    done(response, "GetModelProperties: got properties")
