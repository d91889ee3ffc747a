"""Installs the core with plain pip as well as through catkin."""

from setuptools import find_packages, setup

setup(
    name="bullet_sim",
    version="0.1.0",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"bullet_sim": ["data/**/*", "rendering/shaders/*"]},
    python_requires=">=3.11",
)
