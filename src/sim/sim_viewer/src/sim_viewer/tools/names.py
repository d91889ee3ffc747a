"""Every topic, service and parameter name that the tools use."""

CLOCK = "/clock"
ROSOUT = "/rosout_agg"
TF = "/tf"
TF_STATIC = "/tf_static"

GAZEBO = "/gazebo"  # the simulator's usual name; the next are below it
SCENE = "/scene"
LINK_STATES = "/link_states"
PAUSE = "/pause_physics"
UNPAUSE = "/unpause_physics"
STEP = "/step_physics"  # not of Gazebo itself
RESET_WORLD = "/reset_world"
RESET_SIMULATION = "/reset_simulation"
PHYSICS = "/get_physics_properties"
WORLD = "/get_world_properties"
