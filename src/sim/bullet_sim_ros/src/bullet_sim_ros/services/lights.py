"""Get and set the properties of lights, and delete lights."""

from dataclasses import replace

from gazebo_msgs.srv import DeleteLight, GetLightProperties, SetLightProperties
from std_msgs.msg import ColorRGBA

from bullet_sim.description import LightDescription
from bullet_sim.rendering.scene import Scene
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, service
from bullet_sim_ros.simulation import Simulation

ATTENUATION = ("constant", "linear", "quadratic")


@service(names.GET_LIGHT_PROPERTIES, GetLightProperties)
def get_light_properties(simulation: Simulation, request, response) -> None:
    """Diffuse colour and attenuation, all that the message has; ServiceError if there is no such
    light.
    """
    light = _light(simulation.world.scene, request.light_name, "getLightProperties")
    response.diffuse = ColorRGBA(*light.diffuse)
    for term in ATTENUATION:
        setattr(response, f"attenuation_{term}", getattr(light, term))
    done(response, "")


@service(names.SET_LIGHT_PROPERTIES, SetLightProperties)
def set_light_properties(simulation: Simulation, request, response) -> None:
    """Writes every field (setLightProperties): what a request leaves out becomes 0.

    ServiceError if there is no such light, or a number is impossible.
    """
    light = _light(simulation.world.scene, request.light_name, "setLightProperties")
    terms = {term: getattr(request, f"attenuation_{term}") for term in ATTENUATION}
    if not (convert.is_sane(request.pose, request.direction, request.diffuse, request.specular)
            and all(0 <= value <= convert.LARGEST for value in terms.values())):
        raise ServiceError("setLightProperties: all numbers must be finite and not beyond "
                           f"{convert.LARGEST:g}, those of the attenuation not below 0")
    simulation.world.scene.change_light(replace(
        light,
        cast_shadows=request.cast_shadows,
        diffuse=_colour(request.diffuse),
        specular=_colour(request.specular),
        direction=convert.triple(request.direction),
        pose=convert.pose_from_msg(request.pose),
        **terms,
    ))
    done(response, "")


@service(names.DELETE_LIGHT, DeleteLight)
def delete_light(simulation: Simulation, request, response) -> None:
    """ServiceError if there is no such light; as in deleteLight, its text is about a time-out."""
    scene, name = simulation.world.scene, request.light_name
    if name not in scene.lights:
        raise ServiceError(f'DeleteLight: Timeout reached while removing light "{name}"')
    scene.remove_light(name)
    done(response, f"DeleteLight: {name} successfully deleted")


def _light(scene: Scene, name: str, service: str) -> LightDescription:
    if name not in scene.lights:
        raise ServiceError(f"{service}: Requested light {name} not found!")
    return scene.lights[name]


def _colour(msg: ColorRGBA) -> tuple[float, float, float, float]:
    return (msg.r, msg.g, msg.b, msg.a)
