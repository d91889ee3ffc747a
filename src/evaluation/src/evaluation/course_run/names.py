"""The only file of the run that spells topics and services."""

CAMERA, CAMERA_INFO = "/camera/rgb/image_raw", "/camera/rgb/camera_info"
COMMANDS, ODOMETRY = "/cmd_vel", "/odom"
SENSORS = (CAMERA, "/scan", "/imu", "/joint_states")
WORLD, POSE = "/gazebo/get_world_properties", "/gazebo/get_model_state"
UNPAUSE = "/gazebo/unpause_physics"
