"""Where models, media and packages are: the environment, and what packages export to gazebo_ros."""

from __future__ import annotations

import os
from pathlib import Path

import rospkg

from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats import Resources


def open_resources() -> Resources:
    """Search paths of this process, as Gazebo with its ROS paths plugin has them."""
    packages = rospkg.RosPack()

    def find_package(name: str) -> str:
        try:
            return packages.get_path(name)
        except rospkg.ResourceNotFound:
            raise ResourceNotFound(f"package://{name}", packages.get_ros_paths()) from None

    return Resources.from_environment(
        os.environ,
        extra_model_paths=_exports(packages, "gazebo_model_path"),
        extra_resource_paths=_exports(packages, "gazebo_media_path"),
        find_package=find_package,
    )


def _exports(packages: rospkg.RosPack, attribute: str) -> list[Path]:
    """`<export><gazebo_ros ATTRIBUTE="${prefix}/a:${prefix}/b"/>` of every package."""
    found: dict[Path, None] = {}
    for name in packages.list():
        folder = packages.get_path(name)
        if not _manifest_mentions(Path(folder), attribute):
            continue
        for value in packages.get_manifest(name).get_export("gazebo_ros", attribute):
            value = value.replace("${prefix}", folder)
            found.update((Path(part), None) for part in value.split(":") if part)
    return list(found)


def _manifest_mentions(folder: Path, word: str) -> bool:
    """Whether it is worth parsing: to parse all of them takes longer than to load a world."""
    manifests = [folder / "package.xml", folder / "manifest.xml"]
    return any(word.encode() in file.read_bytes() for file in manifests if file.is_file())
