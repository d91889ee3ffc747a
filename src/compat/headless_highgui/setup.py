"""Puts the package and usercustomize.py on the workspace's Python path."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["headless_highgui"],
        py_modules=["usercustomize"],
        # catkin asks for a module's folder by the module's name, setuptools by "".
        package_dir={"": "src", "usercustomize": "src"},
    )
)
