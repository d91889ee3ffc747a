"""Where a link is, what it weighs, and changing both."""

from gazebo_msgs.msg import LinkState
from gazebo_msgs.srv import (
    GetLinkProperties,
    GetLinkState,
    SetLinkProperties,
    SetLinkState,
)
from geometry_msgs.msg import Point, Quaternion

from bullet_sim.description import Inertial
from bullet_sim.errors import SimulationError
from bullet_sim.pose import Pose
from bullet_sim.scopes import INERTIAL_FRAMES
from bullet_sim.twist import twist_difference, twist_in
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, offer
from bullet_sim_ros.services.lookup import LINK_UNKNOWN, find_frame, find_link
from bullet_sim_ros.simulation import Simulation

INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def offer_link_services(simulation: Simulation) -> None:
    """get_link_state, set_link_state, get_link_properties, set_link_properties."""
    world, mailbox = simulation.world, simulation.mailbox

    def put(request, response):
        set_link_state(world, request.link_state)
        done(response, "SetLinkState: success")

    offer(mailbox, names.GET_LINK_STATE, GetLinkState,
          lambda request, response: get_link_state(world, request, response))
    offer(mailbox, names.SET_LINK_STATE, SetLinkState, put)
    offer(mailbox, names.GET_LINK_PROPERTIES, GetLinkProperties,
          lambda request, response: get_link_properties(world, request.link_name, response))
    offer(mailbox, names.SET_LINK_PROPERTIES, SetLinkProperties,
          lambda request, response: set_link_properties(world, request, response))


def get_link_state(world: World, request, response) -> None:
    """Pose and twist of a link, in the world or relative to another entity."""
    link = find_link(world, request.link_name, f"GetLinkState: {LINK_UNKNOWN}")
    frame, frame_twist = find_frame(
        world, request.reference_frame,
        "GetLinkState: reference reference_frame not found, did you forget to scope the link by "
        "model name?")
    state = response.link_state
    state.link_name, state.reference_frame = request.link_name, request.reference_frame
    state.pose = convert.pose_to_msg(frame.inverse() * link.pose)
    state.twist = convert.twist_to_msg(
        twist_in(frame, twist_difference(link.twist, frame_twist)))
    done(response, "GetLinkState: got state")


def set_link_state(world: World, state: LinkState) -> None:
    """Move a link; the twist is less that of the frame, which only a link can be (upstream).

    ServiceError if link or frame are not there, or a number is impossible.
    """
    link = find_link(world, state.link_name, "SetLinkState: link does not exist")
    if not convert.is_sane(state.pose, state.twist):
        raise ServiceError(
            f"SetLinkState: pose and twist must be finite and not beyond {convert.LARGEST:g}")
    pose, twist = convert.pose_from_msg(state.pose), convert.twist_from_msg(state.twist)
    if state.reference_frame not in INERTIAL_FRAMES:
        frame = find_link(world, state.reference_frame, "SetLinkState: failed")
        pose, twist = frame.pose * pose, twist_difference(twist, frame.twist)
    world.model(link.model.name).move_link(link, pose, twist)


def get_link_properties(world: World, name: str, response) -> None:
    """Mass, centre of mass and inertia; the orientation of the latter's axes is left out."""
    link = find_link(world, name, f"GetLinkProperties: {LINK_UNKNOWN}").description
    response.com.position = Point(*link.inertial.pose.position)
    response.com.orientation = Quaternion(w=1.0)
    response.gravity_mode = link.gravity
    response.mass = link.inertial.mass
    for field, value in zip(INERTIA, link.inertial.inertia, strict=True):
        setattr(response, field, value)
    done(response, "GetLinkProperties: got properties")


def set_link_properties(world: World, request, response) -> None:
    """Writes every field but the orientation of the inertia's axes.

    ServiceError if there is no such link, or a number is impossible.
    """
    link = find_link(world, request.link_name, f"SetLinkProperties: {LINK_UNKNOWN}")
    model = world.model(link.model.name)
    inertia = tuple(getattr(request, field) for field in INERTIA)
    if not (convert.is_sane(request.com)
            and all(abs(value) <= convert.LARGEST for value in (request.mass, *inertia))
            and all(value > 0 for value in (request.mass, *inertia[::3], inertia[5]))):
        raise ServiceError(
            "SetLinkProperties: mass, ixx, iyy and izz must be above 0, and all numbers finite; "
            "get_link_properties tells the present ones")
    old = link.description.inertial
    position = request.com.position
    try:
        centre = Pose((position.x, position.y, position.z), old.pose.orientation)
        model.change_link(link, Inertial(request.mass, centre, inertia), request.gravity_mode)
    except SimulationError as error:
        raise ServiceError(f"SetLinkProperties: {error}") from None
    done(response, "SetLinkProperties: properties set")
