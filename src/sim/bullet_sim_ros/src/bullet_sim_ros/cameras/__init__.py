"""What all camera plugins share: tags, topics, encodings, CameraInfo.

C++ files named here are in gazebo_plugins/src.
"""
