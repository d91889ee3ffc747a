"""Get and set the state and the mass properties of links."""

from gazebo_msgs.msg import LinkState
from gazebo_msgs.srv import GetLinkProperties, GetLinkState, SetLinkProperties, SetLinkState
from geometry_msgs.msg import Point, Quaternion

from bullet_sim.description import Inertial
from bullet_sim.errors import prefixed
from bullet_sim.nested import INERTIAL_FRAMES
from bullet_sim.pose import Pose
from bullet_sim.twist import twist_difference
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, service
from bullet_sim_ros.services.lookup import LINK_UNKNOWN, check_sane, find_link, seen_from
from bullet_sim_ros.simulation import Simulation

INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


@service(names.GET_LINK_STATE, GetLinkState)
def get_link_state(simulation: Simulation, request, response) -> None:
    """Pose and twist of a link, in the world or relative to another entity.

    ServiceError without such a link or frame.
    """
    world = simulation.world
    link = find_link(world, request.link_name, f"GetLinkState: {LINK_UNKNOWN}")
    state = response.link_state
    state.link_name, state.reference_frame = request.link_name, request.reference_frame
    state.pose, state.twist = seen_from(
        world, request.reference_frame, link.pose, link.twist,
        "GetLinkState: reference reference_frame not found, did you forget to scope the link by "
        "model name?")
    done(response, "GetLinkState: got state")


@service(names.SET_LINK_STATE, SetLinkState)
def _set_link_state(simulation: Simulation, request, response) -> None:
    set_link_state(simulation.world, request.link_state)
    done(response, "SetLinkState: success")


def set_link_state(world: World, state: LinkState) -> None:
    """Move a link; the frame's twist is subtracted, and a frame must be a link (setLinkState).

    ServiceError if link or frame do not exist, or a number is impossible.
    """
    link = find_link(world, state.link_name, "SetLinkState: link does not exist")
    check_sane("SetLinkState: pose and twist", state.pose, state.twist)
    pose, twist = convert.pose_from_msg(state.pose), convert.twist_from_msg(state.twist)
    if state.reference_frame not in INERTIAL_FRAMES:
        frame = find_link(world, state.reference_frame, "SetLinkState: failed")
        pose, twist = frame.pose * pose, twist_difference(twist, frame.twist)
    world.model(link.model.name).move_link(link, pose, twist)


@service(names.GET_LINK_PROPERTIES, GetLinkProperties)
def get_link_properties(simulation: Simulation, request, response) -> None:
    """Mass, centre of mass and inertia; the orientation of the inertia's axes is left out.

    ServiceError without such a link.
    """
    link = find_link(simulation.world, request.link_name,
                     f"GetLinkProperties: {LINK_UNKNOWN}").description
    response.com.position = Point(*link.inertial.pose.position)
    response.com.orientation = Quaternion(w=1.0)
    response.gravity_mode = link.gravity
    response.mass = link.inertial.mass
    for field, value in zip(INERTIA, link.inertial.inertia, strict=True):
        setattr(response, field, value)
    done(response, "GetLinkProperties: got properties")


@service(names.SET_LINK_PROPERTIES, SetLinkProperties)
def set_link_properties(simulation: Simulation, request, response) -> None:
    """Writes every field but the orientation of the inertia's axes.

    ServiceError if there is no such link, or a number is impossible.
    """
    link = find_link(simulation.world, request.link_name, f"SetLinkProperties: {LINK_UNKNOWN}")
    model = simulation.world.model(link.model.name)
    inertia = tuple(getattr(request, field) for field in INERTIA)
    if not (convert.is_sane(request.com, request.mass, inertia)
            and all(value > 0 for value in (request.mass, *inertia[::3], inertia[5]))):
        raise ServiceError(
            "SetLinkProperties: mass, ixx, iyy and izz must be above 0, and all numbers finite; "
            "get_link_properties returns the current ones")
    turn = link.description.inertial.pose.orientation
    with prefixed("SetLinkProperties:", ServiceError):
        centre = Pose(convert.triple(request.com.position), turn)
        model.change_link(link, Inertial(request.mass, centre, inertia), request.gravity_mode)
    done(response, "SetLinkProperties: properties set")
