"""Tells catkin where the Python package is."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(
    packages=["bullet_sim_ros", "bullet_sim_ros.cameras", "bullet_sim_ros.plugins",
              "bullet_sim_ros.services"],
    package_dir={"": "src"},
))
