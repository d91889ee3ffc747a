"""Search paths: order, URI prefixes, and errors that name the folders."""

from pathlib import Path

import pytest

from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import DATA_FOLDER, Resources


def touch(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")
    return path


def test_order_of_the_environment(tmp_path):
    # conforms: GAZEBO_MODEL_PATH, GAZEBO_RESOURCE_PATH
    environ = {"HOME": str(tmp_path), "GAZEBO_MODEL_PATH": "/a::/b", "GAZEBO_RESOURCE_PATH": "/r"}
    paths = Resources.from_environment(environ, ["/exported", "/a"], ["/media"])
    assert paths.model_paths == (
        tmp_path / ".gazebo/models", DATA_FOLDER / "models",
        Path("/a"), Path("/b"), Path("/exported"))
    assert paths.resource_paths == (DATA_FOLDER, Path("/r"), Path("/media"))


def test_first_model_path_wins(tmp_path):
    # conforms: uri model://
    touch(tmp_path / "two/X/model.sdf")
    both = Resources([tmp_path / "one", tmp_path / "two"])
    assert both.resolve("model://X/model.sdf") == tmp_path / "two/X/model.sdf"
    first = touch(tmp_path / "one/X/model.sdf")
    assert both.resolve("model://X/model.sdf") == first


def test_three_slashes_are_as_good_as_two(tmp_path):
    mesh = touch(tmp_path / "X/meshes/x.dae")
    assert Resources([tmp_path]).resolve("model:///X/meshes/x.dae") == mesh
    (tmp_path / "X/model.sdf").write_text(
        '<sdf version="1.6"><model name="x"><link name="l"/></model></sdf>')
    world = tmp_path / "w.world"
    world.write_text('<sdf version="1.6"><world name="w"><include><uri>model:///X/model.sdf</uri>'
                     "</include></world></sdf>")
    assert [model.name for model in load_world(world, Resources([tmp_path])).models] == ["x"]


def test_package_file_absolute_and_relative(tmp_path):
    # conforms: uri file://, uri package://
    mesh = touch(tmp_path / "pkg/meshes/a.stl")
    paths = Resources([], [tmp_path], {"pkg": str(tmp_path / "pkg")}.__getitem__)
    assert paths.resolve("package://pkg/meshes/a.stl") == mesh
    assert paths.resolve(f"file://{mesh}") == mesh
    assert paths.resolve("file://pkg/meshes/a.stl") == mesh
    assert paths.resolve(str(mesh)) == mesh
    assert paths.resolve("meshes/a.stl", base=tmp_path / "pkg") == mesh
    assert paths.resolve("meshes/../meshes/a.stl", base=tmp_path / "pkg") == mesh


@pytest.mark.parametrize("uri", [
    "model://arm/meshes/left hand.stl", "model://arm/meshes/left%20hand.stl",
    "model://arm\\meshes\\left hand.stl", " model://arm\\meshes/left%20hand.stl "])
def test_letters_may_be_written_as_in_the_web_and_folders_as_in_windows(tmp_path, uri):
    hand = touch(tmp_path / "arm/meshes/left hand.stl")
    assert Resources([tmp_path]).resolve(uri) == hand


def test_what_is_there_as_written_comes_first(tmp_path):
    touch(tmp_path / "left hand.stl")
    written = touch(tmp_path / "left%20hand.stl")
    assert Resources([tmp_path]).resolve("model://left%20hand.stl") == written


def test_world_is_looked_up_here_then_in_the_resource_paths(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    paths = Resources([], [tmp_path / "share"])
    deep = touch(tmp_path / "share/media/models/w.world")
    assert paths.find_world("w.world") == deep
    share = touch(tmp_path / "share/w.world")
    assert paths.find_world("w.world") == share
    here = touch(tmp_path / "w.world")
    assert paths.find_world("w.world") == here


@pytest.mark.parametrize("uri, message", [
    ("model://X/y", r"model://X/y not found \(searched: /m/X\)"),
    ("http://host/x", r"http://host/x not found \(searched: nowhere. Unknown URI prefix: nothing"),
    ("fuel2://x", r"searched: nowhere. Unknown URI prefix; known: model package file\)"),
    ("package://gone/x", r"package gone not found \(searched: no package finder was given\)"),
    ("/abs/x.stl", r"/abs/x.stl not found \(searched: /abs\)"),
])
def test_what_is_not_there(uri, message):
    with pytest.raises(ResourceNotFound, match=message):
        Resources(["/m"]).resolve(uri)


@pytest.mark.parametrize("uri, meant", [
    ("model://tabel", "table"), ("model://tabel/meshes/top.dae", "table"),
    ("model://table/mesh/top.dae", "meshes"), ("model://table/meshes/tob.dae", "top.dae")])
def test_the_name_that_is_meant(tmp_path, uri, meant):
    (tmp_path / "b/table/meshes").mkdir(parents=True)
    (tmp_path / "b/table/meshes/top.dae").touch()
    (tmp_path / "a").mkdir()
    with pytest.raises(ResourceNotFound) as caught:
        Resources([tmp_path / "a", tmp_path / "b", tmp_path / "gone"]).resolve(uri)
    assert str(caught.value).endswith(f"(did you mean {meant}?)")


def test_the_world_in_this_folder_that_is_meant(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "yard.world").touch()
    with pytest.raises(ResourceNotFound, match=r"\(did you mean yard\.world\?\)"):
        Resources().find_world("yart.world")
