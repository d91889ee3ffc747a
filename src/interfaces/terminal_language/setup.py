"""Puts the package with its catalogues on the workspace's Python path."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["terminal_language"],
        package_dir={"": "src"},
        package_data={"terminal_language": [
            "locale/*.po", "locale/kept.txt", "locale/*/LC_MESSAGES/*.mo"]},
    )
)
