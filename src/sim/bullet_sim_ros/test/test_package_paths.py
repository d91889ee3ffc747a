"""What packages export to gazebo_ros becomes search paths."""

import os
from pathlib import Path

import pytest

from bullet_sim.errors import ResourceNotFound
from bullet_sim_ros.package_paths import open_resources

MANIFEST = """<package format="2"><name>{name}</name><version>1.0.0</version>
  <description>of a test</description><maintainer email="a@b.de">a</maintainer>
  <license>MIT</license><export>{export}</export></package>"""


@pytest.fixture
def packages(tmp_path, monkeypatch):
    """Makes packages of a name and the content of `<export>`; they are all there are."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    monkeypatch.setenv("ROS_ROOT", str(tmp_path))
    for name in ("GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH"):
        monkeypatch.delenv(name, raising=False)

    def make(name: str, export: str) -> Path:
        folder = tmp_path / name
        folder.mkdir()
        (folder / "package.xml").write_text(MANIFEST.format(name=name, export=export))
        return folder

    return make


def test_exports_of_packages_are_search_paths(packages):
    # conforms: package.xml <gazebo_ros>/gazebo_model_path
    # conforms: package.xml <gazebo_ros>/gazebo_media_path
    packages("plain", "")
    packages("other", '<other gazebo_model_path="${prefix}/not_for_us"/>')
    folder = packages("full", '<gazebo_ros gazebo_model_path="${prefix}/a:${prefix}/b"/>'
                              '<gazebo_ros gazebo_media_path="${prefix}/media"/>')
    for path in ("a/one", "b/two", "media/worlds"):
        (folder / path).mkdir(parents=True)
    (folder / "media/worlds/small.world").write_text("<sdf/>")
    resources = open_resources()
    assert [path for path in resources.model_paths if folder in path.parents] == [
        folder / "a", folder / "b"]
    assert resources.find_world("worlds/small.world") == folder / "media/worlds/small.world"
    assert not any("not_for_us" in str(path) for path in resources.model_paths)
    assert Path(resources.package_folder("full")) == folder


@pytest.mark.parametrize("broken, said", [
    ("<package><name>bad</name><maintainer email='a@b.c'>a</maintainer>EXPORT</package>", None),
    ("<package>EXPORT</package>", None),
    ("<package format='2'><name>bad</name><version>one</version>EXPORT</package>", None),
    ("<package><name>bad</name>EXPORT", "bad/package.xml is not well-formed XML"),
    ("<package><name>bad</name>EXPORT<version>&nbsp;</package>", "is not well-formed"),
])
def test_a_manifest_that_rospkg_refuses_does_not_end_the_simulator(packages, caplog, broken, said):
    good = packages("good", '<gazebo_ros gazebo_model_path="${prefix}/models"/>')
    bad = packages("bad", "")
    (bad / "package.xml").write_text(
        broken.replace("EXPORT", '<export><gazebo_ros gazebo_model_path="${prefix}/m"/></export>'))
    paths = open_resources().model_paths
    assert good / "models" in paths
    assert (bad / "m" in paths) == (said is None)
    lines = [record.getMessage() for record in caplog.records]
    assert len(lines) == (said is not None) and all(said in line for line in lines)


def test_a_manifest_of_another_kind_is_not_waited_for(packages):
    os.remove(packages("pipe", "") / "package.xml")
    os.mkfifo(Path(os.environ["ROS_ROOT"]) / "pipe/manifest.xml")
    open_resources()


def test_a_package_that_is_not_there(packages):
    packages("plain", "")
    with pytest.raises(ResourceNotFound, match="package://gone"):
        open_resources().package_folder("gone")
