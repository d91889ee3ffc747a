"""Installs the algorithms with pip as well as through catkin."""

from setuptools import find_packages, setup

setup(
    name="nav_algorithms",
    version="0.1.0",
    package_dir={"": "src"},
    packages=find_packages("src"),
    python_requires=">=3.11",
)
