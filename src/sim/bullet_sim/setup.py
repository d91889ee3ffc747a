"""Installs the core with pip; catkin reads packages and package_dir from it.

It makes data/models first, which is part of the package and not committed.
"""

import runpy
from pathlib import Path

from setuptools import find_packages, setup

HERE = Path(__file__).resolve().parent
runpy.run_path(str(HERE / "src/bullet_sim/props.py"), run_name="__main__")
setup(
    name="bullet_sim",
    version=runpy.run_path(str(HERE / "src/bullet_sim/__init__.py"))["__version__"],
    description="Gazebo's models, worlds, sensors and cameras on PyBullet, without ROS",
    long_description=(HERE / "README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    license="BSD-3-Clause",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"bullet_sim": ["py.typed", "data/**/*"]},
    python_requires=">=3.11",
    install_requires=[
        "fast-simplification>=0.2,<0.3",  # its loss-free mode has a tolerance, see meshes/detail.py
        "lxml>=4.9,<7",  # for trimesh: .dae
        "moderngl>=5.10,<6",  # releases textures by weak references, which 5.6 lacks
        "numpy>=1.26,<3",
        "opencv-python-headless>=4.8,<5",
        "pybullet>=3.2.5,<4",
        "pycollada>=0.8,<1",  # .dae
        "scipy>=1.11,<2",  # for trimesh
        "trimesh>=4.4,<6",  # .ply, .off, .glb, .gltf
        "xacro>=2.1,<3",
    ],
    extras_require={"test": ["pytest>=7,<10"]},
)
