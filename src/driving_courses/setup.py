"""Installs the environments with plain pip, with the courses' files; catkin reads packages and
package_dir of it."""

import shutil
import sys
from pathlib import Path

from setuptools import find_packages, setup
from setuptools.command.build_py import build_py

HERE = Path(__file__).resolve().parent
COPIED = ("config", "courses", "meshes", "models", "tracks", "urdf", "worlds")  # folders
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.onnx")


class BuildWithCourses(build_py):
    """Copies worlds, robots and tracks of the other packages into the wheel."""

    def run(self):
        super().run()
        if "install" in sys.argv:  # catkin: the packages lie in share/
            return
        sys.path.insert(0, str(HERE / "src"))
        from driving_courses.packages import FOLDERS

        for name, folder in FOLDERS.items():
            package = HERE.parent / folder
            copy = Path(self.build_lib, "driving_courses", "packages", name)
            for part in filter(Path.is_dir, (package / part for part in COPIED)):
                shutil.copytree(part, copy / part.name, ignore=LEFT_OUT, dirs_exist_ok=True)
            shutil.copy(package / "package.xml", copy)


setup(
    name="driving_courses",
    version="0.1.0",
    description="Driving courses as Gymnasium environments, without ROS",
    license="BSD-3-Clause",
    cmdclass={"build_py": BuildWithCourses},
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"driving_courses": ["courses/*.yaml"]},
    python_requires=">=3.11",
    install_requires=["bullet_sim", "car_control", "evaluation", "gymnasium>=1.0,<2", "node_basics",
                      "PyYAML>=6", "racecar_description"],
)
