"""Installs the package through catkin."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["node_basics"], package_dir={"": "src"}))
