"""Installs the package's modules with plain pip as well as through catkin."""

from setuptools import find_packages, setup

setup(
    name="node_basics",
    version="0.1.0",
    package_dir={"": "src"},
    packages=find_packages("src"),
    python_requires=">=3.11",
    install_requires=["numpy", "PyYAML"],
)
