"""Spawning and deleting models."""

import copy
import dataclasses
import re
from xml.etree.ElementTree import SubElement

from gazebo_msgs.srv import DeleteModel, SpawnModel

from bullet_sim.description import ModelDescription, PluginDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_light, load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.pose import IDENTITY
from bullet_sim_ros import names
from bullet_sim_ros.services.answers import CallFails, ServiceError, done, offer
from bullet_sim_ros.services.lookup import find_model
from bullet_sim_ros.services.states import is_turnless, spawn_pose

SPAWNED = "SpawnModel: Successfully spawned entity"
TAKEN = "SpawnModel: Failure - entity already exists."
UNKNOWN_PACKAGE = "urdf reference package name does not exist"
URDF_ROOT = re.compile(r"<robot[\s>/]")


def offer_model_services(simulation, resources: Resources) -> None:
    """spawn_urdf_model, spawn_sdf_model, delete_model."""

    def spawn(request, response):
        name = request.model_name
        pose = spawn_pose(simulation.world, request)
        light = load_light(request.model_xml, resources, name or None)
        if light is not None:
            if light.name in simulation.world.scene.lights:
                raise ServiceError(TAKEN)
            simulation.world.scene.add_light(light)
            done(response, SPAWNED)
            return
        description = load_model(request.model_xml, resources, name or None)
        if description.name in simulation.world.models:
            raise ServiceError(TAKEN)
        if is_turnless(request.initial_pose):
            description = dataclasses.replace(description, pose=IDENTITY)
        if request.robot_namespace:
            description = with_namespace(description, request.robot_namespace)
        simulation.spawn(description, pose, description.name)
        done(response, SPAWNED)

    def spawn_urdf(request, response):
        if not URDF_ROOT.search(request.model_xml):
            raise CallFails("SpawnModel: Failure - entity format is invalid.")
        try:
            spawn(request, response)
        except FormatError as error:
            if UNKNOWN_PACKAGE in str(error):
                raise CallFails(str(error)) from None
            raise

    def delete(request, response):
        model = find_model(simulation.world, request.model_name,
                           "DeleteModel: model does not exist")
        simulation.delete(model.name)
        done(response, "DeleteModel: successfully deleted model")

    offer(simulation.mailbox, names.SPAWN_URDF_MODEL, SpawnModel, spawn_urdf)
    offer(simulation.mailbox, names.SPAWN_SDF_MODEL, SpawnModel, spawn)
    offer(simulation.mailbox, names.DELETE_MODEL, DeleteModel, delete)


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
