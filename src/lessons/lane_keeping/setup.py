"""Tells catkin where the Python packages are."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(
    packages=["lane_keeping", "lane_keeping.methods"], package_dir={"": "src"}))
