"""Tells catkin where the Python packages are."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(
    packages=["ai_robot_tracking", "ai_robot_tracking.detection"], package_dir={"": "src"}))
