"""Get and set the poses, twists and joint positions of models."""

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import GetModelState, SetModelConfiguration, SetModelState
from geometry_msgs.msg import Pose as PoseMsg

from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import Twist
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.services.answers import ServiceError, done, service
from bullet_sim_ros.services.lookup import check_sane, find_frame, find_model, find_part, seen_from
from bullet_sim_ros.simulation import Simulation


@service(names.GET_MODEL_STATE, GetModelState)
def get_model_state(simulation: Simulation, request, response) -> None:
    """Pose and twist of a model, in the world or relative to another entity.

    ServiceError without such a model or frame.
    """
    world, calls = simulation.world, simulation.state_calls
    convert.stamped(response, world.time, request.relative_entity_name)
    model = find_part(world, request.model_name, "GetModelState: model does not exist")
    response.pose, response.twist = seen_from(
        world, request.relative_entity_name, model.pose, model.twist,
        "GetModelState: reference relative_entity_name not found, did you forget to scope the "
        "body by model name?")
    calls[request.model_name] += 1
    response.header.seq = calls[request.model_name]
    done(response, "GetModelState: got properties")


@service(names.SET_MODEL_STATE, SetModelState)
def _set_model_state(simulation: Simulation, request, response) -> None:
    set_model_state(simulation.world, request.model_state)
    done(response, "SetModelState: set model state done")


def set_model_state(world: World, state: ModelState) -> None:
    """Move a model and set its velocity; both are in the axes of the reference entity.

    ServiceError if model or entity do not exist, or a number is impossible.
    """
    model = find_model(world, state.model_name, "SetModelState: model does not exist")
    check_sane("SetModelState: pose and twist", state.pose, state.twist)
    frame, _ = find_frame(world, state.reference_frame,
                          "SetModelState: specified reference frame entity does not exist")
    twist = convert.twist_from_msg(state.twist)
    model.set_pose(frame * convert.pose_from_msg(state.pose))
    model.set_twist(Twist(rotate(frame.orientation, twist.linear),
                          rotate(frame.orientation, twist.angular)))


@service(names.SET_MODEL_CONFIGURATION, SetModelConfiguration)
def set_model_configuration(simulation: Simulation, request, response) -> None:
    """Set joint positions at once; unknown joints are ignored (Model::SetJointPositions).

    ServiceError if there is no such model, or the positions are impossible.
    """
    model = find_model(simulation.world, request.model_name,
                       "SetModelConfiguration: model does not exist")
    if len(request.joint_names) != len(request.joint_positions):
        raise ServiceError(
            "SetModelConfiguration: joint name and position list have different lengths")
    check_sane("SetModelConfiguration: joint_positions", request.joint_positions)
    for name, position in zip(request.joint_names, request.joint_positions, strict=True):
        if name in model.joints:
            model.joints[name].reset(position)
    done(response, "SetModelConfiguration: success")


def spawn_pose(world: World, request) -> Pose:
    """The initial pose of a spawn request, in the world; ServiceError if it is impossible."""
    check_sane("SpawnModel: initial_pose", request.initial_pose)
    frame, _ = find_frame(
        world, request.reference_frame,
        "SpawnModel: reference reference_frame not found, did you forget to scope the link by "
        "model name?")
    pose = frame * convert.pose_from_msg(request.initial_pose)
    return Pose(pose.position) if is_turnless(request.initial_pose) else pose


def is_turnless(pose: PoseMsg) -> bool:
    """Whether the orientation is (0, 0, 0, 0), as in a message that was not filled in.

    In the arithmetic of spawnSDFModel and updateSDFAttributes such a quaternion cancels the
    rotation of the reference frame and the model's own pose.
    """
    turn = pose.orientation
    return not any((turn.x, turn.y, turn.z, turn.w))
