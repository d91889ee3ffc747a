"""Installs the package's modules with plain pip as well as through catkin."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = ElementTree.parse(Path(__file__).resolve().with_name("package.xml"))
VERSION = PACKAGE.findtext("version")
setup(
    name="ai_robot_tracking",
    version=VERSION,
    description=PACKAGE.findtext("description"),
    license=PACKAGE.findtext("license"),
    package_dir={"": "src"},
    packages=find_packages("src", exclude=["ai_robot_tracking.training*"]),
    python_requires=">=3.11",
    install_requires=[f"node_basics=={VERSION}", "numpy>=1.26,<3",
                      "opencv-python-headless>=4.8,<5", "PyYAML>=6"],
)
