"""Where models, media and packages are: the environment, and what packages export to gazebo_ros."""

import os
from pathlib import Path

import rospkg

from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats import Resources
from bullet_sim_ros.package_list import Package, list_packages


def open_resources() -> Resources:
    """Search paths of this process, like those of gazebo_ros_paths_plugin.cpp."""
    ros_paths = rospkg.get_ros_paths()
    packages = list_packages(ros_paths)

    def find_package(name: str) -> str:
        if name not in packages:
            raise ResourceNotFound(f"package://{name}", ros_paths)
        return str(packages[name].folder)

    return Resources.from_environment(
        os.environ,
        extra_model_paths=_exports(packages, "gazebo_model_path"),
        extra_resource_paths=_exports(packages, "gazebo_media_path"),
        find_package=find_package,
    )


def _exports(packages: dict[str, Package], attribute: str) -> list[Path]:
    """`<export><gazebo_ros ATTRIBUTE="${prefix}/a:${prefix}/b"/>` of every package."""
    found: dict[Path, None] = {}
    for package in packages.values():
        for export in package.manifest.findall("export/gazebo_ros"):
            value = export.get(attribute, "").replace("${prefix}", str(package.folder))
            found.update((Path(part), None) for part in value.split(":") if part)
    return list(found)
