"""Tells catkin where the package's module is."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["rqt_pages"], package_dir={"": "src"}))
