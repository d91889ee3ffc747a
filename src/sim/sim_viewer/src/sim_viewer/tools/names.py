"""Every topic, service and parameter name that the tools use."""

CLOCK = "/clock"
ROSOUT = "/rosout_agg"
TF = "/tf"
TF_STATIC = "/tf_static"

GAZEBO = "/gazebo"
PAUSE = "/gazebo/pause_physics"
UNPAUSE = "/gazebo/unpause_physics"
RESET_WORLD = "/gazebo/reset_world"
RESET_SIMULATION = "/gazebo/reset_simulation"
PHYSICS = "/gazebo/get_physics_properties"

BAG_FOLDER = "~bags"
