"""The simulator's services that a run uses; topics come from the course file."""

WORLD, POSE = "/gazebo/get_world_properties", "/gazebo/get_model_state"
UNPAUSE = "/gazebo/unpause_physics"
LIST_CONTROLLERS = "controller_manager/list_controllers"  # below its namespace
