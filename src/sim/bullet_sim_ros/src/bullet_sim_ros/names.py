"""Every topic and service name of the simulator, and how plugins' relative names resolve."""

import rospy

CLOCK = "/clock"
MODEL_STATES = "~model_states"
LINK_STATES = "~link_states"
SCENE = "~scene"
SET_MODEL_STATE = "~set_model_state"
SET_LINK_STATE = "~set_link_state"
PERFORMANCE_METRICS = "~performance_metrics"

SPAWN_URDF_MODEL = "~spawn_urdf_model"
SPAWN_SDF_MODEL = "~spawn_sdf_model"
DELETE_MODEL = "~delete_model"
DELETE_LIGHT = "~delete_light"
GET_MODEL_STATE = "~get_model_state"
SET_MODEL_CONFIGURATION = "~set_model_configuration"
GET_LINK_STATE = "~get_link_state"
GET_LINK_PROPERTIES = "~get_link_properties"
SET_LINK_PROPERTIES = "~set_link_properties"
GET_JOINT_PROPERTIES = "~get_joint_properties"
SET_JOINT_PROPERTIES = "~set_joint_properties"
GET_LIGHT_PROPERTIES = "~get_light_properties"
SET_LIGHT_PROPERTIES = "~set_light_properties"
APPLY_BODY_WRENCH = "~apply_body_wrench"
APPLY_JOINT_EFFORT = "~apply_joint_effort"
CLEAR_BODY_WRENCHES = "~clear_body_wrenches"
CLEAR_JOINT_FORCES = "~clear_joint_forces"
GET_MODEL_PROPERTIES = "~get_model_properties"
GET_PHYSICS_PROPERTIES = "~get_physics_properties"
SET_PHYSICS_PROPERTIES = "~set_physics_properties"
GET_WORLD_PROPERTIES = "~get_world_properties"
PAUSE_PHYSICS = "~pause_physics"
UNPAUSE_PHYSICS = "~unpause_physics"
STEP_PHYSICS = "~step_physics"  # an addition: Gazebo steps only by its own transport
RESET_WORLD = "~reset_world"
RESET_SIMULATION = "~reset_simulation"
SET_PARAMETERS = "~set_parameters"

USE_SIM_TIME = "/use_sim_time"
PUB_CLOCK_FREQUENCY = "~pub_clock_frequency"
PUB_STATE_FREQUENCY = "~pub_state_frequency"
ENABLE_ROS_NETWORK = "~enable_ros_network"
LOCKSTEP = "~lockstep"
LOCKSTEP_TIMEOUT = "~lockstep_timeout"
LOCKSTEP_SENSOR = "~lockstep_sensor"
STATE_LOG = "~state_log"
RECORDING = "~recording"
RUN_LOG = "~run_log"
RUN_LOG_OF = "~run_log_of"  # JSON text: what the log's header says of the run
REPLAY = "~replay"
REPLAY_TO = "~replay_to"  # number of the image that the service goes to
GO_TO_IMAGE = "~go_to_image"
PROFILE = "~profile"
RUNNING = "~running"  # set by the node: {world: its file's name, since: s, wall}


def join(namespace: str, name: str) -> str:
    """`name` below `namespace`; absolute names stay, a relative namespace is below the node's."""
    if name.startswith("/"):
        return name
    base = namespace if namespace.startswith("/") else rospy.get_namespace() + namespace
    parts = [part for part in f"{base}/{name}".split("/") if part]
    return "/" + "/".join(parts)


def frame(prefix: str, name: str) -> str:
    """A tf frame: names with a leading slash only lose that, others get the tf_prefix."""
    if name.startswith("/"):
        return name.lstrip("/")
    prefix = prefix.strip("/")
    return f"{prefix}/{name}" if prefix else name
