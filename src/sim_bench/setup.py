"""Tells catkin where the Python package is."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(
    packages=["sim_bench", "sim_bench.parts"],
    package_dir={"": "src"},
))
