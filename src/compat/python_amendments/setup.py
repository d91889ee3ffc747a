"""Puts the package on the workspace's Python path; CMakeLists.txt does so with usercustomize.py."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["python_amendments"],
        package_dir={"": "src"},
    )
)
