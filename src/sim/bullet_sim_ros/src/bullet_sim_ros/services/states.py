"""Where models are, and putting them elsewhere."""

from collections import Counter

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import GetModelState, SetModelConfiguration, SetModelState
from geometry_msgs.msg import Pose as PoseMsg

from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import Twist, twist_difference, twist_in
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, offer
from bullet_sim_ros.services.lookup import find_frame, find_model, find_part


def offer_state_services(simulation) -> None:
    """get_model_state, set_model_state, set_model_configuration."""
    world, calls = simulation.world, Counter()

    def get(request, response):
        get_model_state(world, request, response)
        calls[request.model_name] += 1
        response.header.seq = calls[request.model_name]

    def set_(request, response):
        set_model_state(world, request.model_state)
        done(response, "SetModelState: set model state done")

    def configure(request, response):
        set_model_configuration(world, request)
        done(response, "SetModelConfiguration: success")

    offer(simulation.mailbox, names.GET_MODEL_STATE, GetModelState, get)
    offer(simulation.mailbox, names.SET_MODEL_STATE, SetModelState, set_)
    offer(simulation.mailbox, names.SET_MODEL_CONFIGURATION, SetModelConfiguration, configure)


def get_model_state(world: World, request, response) -> None:
    """Pose and twist of a model, in the world or relative to another entity."""
    convert.stamped(response, world.time, request.relative_entity_name)
    model = find_part(world, request.model_name, "GetModelState: model does not exist")
    frame, frame_twist = find_frame(
        world, request.relative_entity_name,
        "GetModelState: reference relative_entity_name not found, did you forget to scope the "
        "body by model name?")
    response.pose = convert.pose_to_msg(frame.inverse() * model.pose)
    response.twist = convert.twist_to_msg(
        twist_in(frame, twist_difference(model.twist, frame_twist)))
    done(response, "GetModelState: got properties")


def set_model_state(world: World, state: ModelState) -> None:
    """Move a model and set its velocity; both are in the axes of the reference entity.

    ServiceError if model or entity are not there, or a number is impossible.
    """
    model = find_model(world, state.model_name, "SetModelState: model does not exist")
    if not convert.is_sane(state.pose, state.twist):
        raise ServiceError(
            f"SetModelState: pose and twist must be finite and not beyond {convert.LARGEST:g}")
    frame, _ = find_frame(world, state.reference_frame,
                          "SetModelState: specified reference frame entity does not exist")
    twist = convert.twist_from_msg(state.twist)
    model.set_pose(frame * convert.pose_from_msg(state.pose))
    model.set_twist(Twist(rotate(frame.orientation, twist.linear),
                          rotate(frame.orientation, twist.angular)))


def set_model_configuration(world: World, request) -> None:
    """Joint positions at once; unknown joints are ignored, as upstream does.

    ServiceError if there is no such model, or the positions are impossible.
    """
    model = find_model(world, request.model_name, "SetModelConfiguration: model does not exist")
    if len(request.joint_names) != len(request.joint_positions):
        raise ServiceError(
            "SetModelConfiguration: joint name and position list have different lengths")
    if not all(abs(position) <= convert.LARGEST for position in request.joint_positions):
        raise ServiceError("SetModelConfiguration: joint_positions must be finite and not beyond "
                           f"{convert.LARGEST:g}")
    for name, position in zip(request.joint_names, request.joint_positions, strict=True):
        if name in model.joints:
            model.joints[name].reset(position)


def spawn_pose(world: World, request) -> Pose:
    """The wanted pose of a spawn request, in the world; ServiceError if it is impossible."""
    if not convert.is_sane(request.initial_pose):
        raise ServiceError(
            f"SpawnModel: initial_pose must be finite and not beyond {convert.LARGEST:g}")
    frame, _ = find_frame(
        world, request.reference_frame,
        "SpawnModel: reference reference_frame not found, did you forget to scope the link by "
        "model name?")
    pose = frame * convert.pose_from_msg(request.initial_pose)
    return Pose(pose.position) if is_turnless(request.initial_pose) else pose


def is_turnless(pose: PoseMsg) -> bool:
    """Whether the orientation is (0, 0, 0, 0), as in a message that was not filled in.

    In the arithmetic of upstream's spawn services such a turn makes all others vanish: that of the
    reference frame, and the model's own pose.
    """
    turn = pose.orientation
    return not any((turn.x, turn.y, turn.z, turn.w))
