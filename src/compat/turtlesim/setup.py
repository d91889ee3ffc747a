"""Tells catkin where the package's modules are."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["turtlesim", "turtlesim.pond"],
        package_dir={"": "src"},
    )
)
