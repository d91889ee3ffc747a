"""Every topic, service and parameter name that the tools use."""

import rosgraph

CLOCK = "/clock"
ROSOUT = "/rosout_agg"
TF = "/tf"
TF_STATIC = "/tf_static"

GAZEBO = "/gazebo"  # the simulator's usual name; the next are below it
SCENE = "/scene"
LINK_STATES = "/link_states"
PAUSE = "/pause_physics"
UNPAUSE = "/unpause_physics"
STEP = "/step_physics"  # Gazebo itself does not have it
RESET_WORLD = "/reset_world"
RESET_SIMULATION = "/reset_simulation"
PHYSICS = "/get_physics_properties"
WORLD = "/get_world_properties"
RUN_LOG = "/run_log"  # parameters of the simulator: the log that it writes
REPLAY = "/replay"  # the one that it repeats

CARRY_OUT = "/replay/carry_out"  # of make replay, with the parameter
REPLAY_WORD = "/replay/word"

LONGEST_TOPIC = 256  # characters


def is_topic(name: str) -> bool:
    """Whether a page may use this as a topic's name; private names (~) are not allowed."""
    return (len(name) <= LONGEST_TOPIC and rosgraph.names.is_legal_name(name)
            and not name.startswith("~"))
