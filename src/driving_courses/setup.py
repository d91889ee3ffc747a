"""Installs the environments with plain pip, with the courses' files; catkin reads packages and
package_dir of it."""

import shutil
import sys
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

HERE = Path(__file__).resolve().parent
PACKAGE = ElementTree.parse(HERE / "package.xml")
VERSION = PACKAGE.findtext("version")
OURS = ("ai_robot_tracking", "bullet_sim", "car_control", "evaluation", "node_basics",
        "racecar_description")
COPIED = ("config", "courses", "meshes", "models", "tracks", "urdf", "worlds")  # folders
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.onnx")


def copy_courses(modules):
    """Copies worlds, robots and tracks of the other packages beside those modules."""
    sys.path.insert(0, str(HERE / "src"))
    from driving_courses.packages import FOLDERS, find_package

    for name in FOLDERS:
        package, copy = find_package(name), Path(modules, "driving_courses", "packages", name)
        for part in filter(Path.is_dir, (package / part for part in COPIED)):
            shutil.copytree(part, copy / part.name, ignore=LEFT_OUT, dirs_exist_ok=True)
        shutil.copy(package / "package.xml", copy)


class BuildWithCourses(build_py):
    """For a wheel."""

    def run(self):
        super().run()
        if "install" not in sys.argv:  # catkin: the packages lie in share/
            copy_courses(self.build_lib)


class SdistWithCourses(sdist):
    """For a source package, from which a wheel is built elsewhere."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        copy_courses(Path(base_dir, "src"))


setup(
    name="driving_courses",
    version=VERSION,
    description="Driving courses as Gymnasium environments, without ROS",
    long_description=(HERE / "README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    license=PACKAGE.findtext("license"),
    cmdclass={"build_py": BuildWithCourses, "sdist": SdistWithCourses},
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"driving_courses": ["courses/*.yaml"]},
    python_requires=">=3.11",
    install_requires=[*(f"{name}=={VERSION}" for name in OURS), "gymnasium>=1.0,<2",
                      "numpy>=1.26,<3", "opencv-python-headless>=4.8,<5", "PyYAML>=6"],
)
