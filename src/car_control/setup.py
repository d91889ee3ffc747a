"""Tells catkin where the package's modules are."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["car_control", "car_control.driving", "car_control.lane"],
        package_dir={"": "src"},
    )
)
