"""What all camera plugins share: tags, topics, encodings, CameraInfo.

Files named here are those of gazebo_plugins/src.
"""
