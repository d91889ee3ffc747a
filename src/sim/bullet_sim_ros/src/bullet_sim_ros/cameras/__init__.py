"""What all camera plugins share: tags, topics, encodings, CameraInfo.

"Upstream" is gazebo_plugins/src/gazebo_ros_camera_utils.cpp, of a depth camera
gazebo_ros_openni_kinect.cpp and gazebo_ros_depth_camera.cpp.
"""
