"""bullet_sim: Gazebo's models and worlds on PyBullet, cameras without a GPU. Independent of ROS."""

import os

__version__ = "1.0.0"  # of the whole repository; all that shows it reads it here

# Read once by OpenCV, when the first module here imports it: a TIFF of 1 MB may unpack to 5 GB.
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(10**8))  # images.MOST_PIXELS
