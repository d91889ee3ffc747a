"""Spawning and deleting models."""

import copy
import dataclasses
import re
from xml.etree.ElementTree import SubElement

from gazebo_msgs.srv import DeleteModel, SpawnModel

from bullet_sim.description import LightDescription, ModelDescription, PluginDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_entity
from bullet_sim.pose import IDENTITY
from bullet_sim_ros import names
from bullet_sim_ros.services.answers import CallFails, ServiceError, done, service
from bullet_sim_ros.services.lookup import find_model
from bullet_sim_ros.services.states import is_turnless, spawn_pose
from bullet_sim_ros.simulation import Simulation

SPAWNED = "SpawnModel: Successfully spawned entity"
TAKEN = "SpawnModel: Failure - entity already exists."
UNKNOWN_PACKAGE = "urdf reference package name does not exist"
URDF_ROOT = re.compile(r"<robot[\s>/]")


@service(names.SPAWN_SDF_MODEL, SpawnModel)
def spawn(simulation: Simulation, request, response) -> None:
    """A model or light from SDF or URDF text.

    ServiceError if the name is taken, FormatError if the text is wrong.
    """
    world, name = simulation.world, request.model_name or None
    pose = spawn_pose(world, request)
    description = load_entity(request.model_xml, simulation.resources, name)
    if isinstance(description, LightDescription):
        if description.name in world.scene.lights:
            raise ServiceError(TAKEN)
        world.scene.add_light(description)
        done(response, SPAWNED)
        return
    if description.name in world.models:
        raise ServiceError(TAKEN)
    if is_turnless(request.initial_pose):
        description = dataclasses.replace(description, pose=IDENTITY)
    if request.robot_namespace:
        description = with_namespace(description, request.robot_namespace)
    simulation.spawn(description, pose, description.name)
    done(response, SPAWNED)


@service(names.SPAWN_URDF_MODEL, SpawnModel)
def spawn_urdf(simulation: Simulation, request, response) -> None:
    """The same for a URDF alone.

    CallFails if it is none, or names an unknown package; ServiceError and FormatError as above.
    """
    if not URDF_ROOT.search(request.model_xml):
        raise CallFails("SpawnModel: Failure - entity format is invalid.")
    try:
        spawn(simulation, request, response)
    except FormatError as error:
        if UNKNOWN_PACKAGE in str(error):
            raise CallFails(str(error)) from None
        raise


@service(names.DELETE_MODEL, DeleteModel)
def delete(simulation: Simulation, request, response) -> None:
    """Take a model out of the world. ServiceError if there is none of that name."""
    model = find_model(simulation.world, request.model_name, "DeleteModel: model does not exist")
    simulation.delete(model.name)
    done(response, "DeleteModel: successfully deleted model")


def with_namespace(description: ModelDescription, namespace: str) -> ModelDescription:
    """Give every plugin without a `<robotNamespace>` this one, at any depth."""
    def named(plugin: PluginDescription) -> PluginDescription:
        if plugin.element.find("robotNamespace") is not None:
            return plugin
        element = copy.deepcopy(plugin.element)
        SubElement(element, "robotNamespace").text = namespace
        return dataclasses.replace(plugin, element=element)

    def inside(element):
        return dataclasses.replace(element, plugins=tuple(map(named, element.plugins)))

    def in_link(link):
        return dataclasses.replace(link, sensors=tuple(map(inside, link.sensors)),
                                   visuals=tuple(map(inside, link.visuals)))

    return dataclasses.replace(inside(description), links=tuple(map(in_link, description.links)))
