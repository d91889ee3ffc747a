"""Installs the package's modules with plain pip as well as through catkin."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = ElementTree.parse(Path(__file__).resolve().with_name("package.xml"))
VERSION = PACKAGE.findtext("version")
setup(
    name="evaluation",
    version=VERSION,
    description=PACKAGE.findtext("description"),
    license=PACKAGE.findtext("license"),
    package_dir={"": "src"},
    packages=find_packages("src"),
    python_requires=">=3.11",
    install_requires=[f"ai_robot_tracking=={VERSION}", "numpy>=1.26,<3",
                      f"racecar_description=={VERSION}"],
)
