"""Files that a model names and that must not be opened: pipes, devices, what is too large."""

import os
import signal

import pytest

from bullet_sim.description import Heightmap, ImageExtrusion, Mesh
from bullet_sim.errors import FormatError
from bullet_sim.files import check_file
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.sdf.material import LARGEST_SCRIPT
from bullet_sim.meshes.generated import generated_parts
from bullet_sim.meshes.images import load_image
from bullet_sim.meshes.loading import load_mesh

MODEL = """<sdf version="1.6"><model name="m"><link name="l"><visual name="v"><geometry><sphere/>
    </geometry><material>{}</material></visual></link></model></sdf>"""


@pytest.fixture(autouse=True)
def not_for_ever():
    """Where a pipe is opened after all, the test ends."""
    signal.alarm(20)
    yield
    signal.alarm(0)


@pytest.fixture
def pipe(tmp_path):
    def make(name: str) -> str:
        os.mkfifo(tmp_path / name)
        return str(tmp_path / name)
    return make


def script(uri: str) -> str:
    return MODEL.format(f"<script><uri>file://{uri}</uri><name>Mine</name></script>")


def test_a_pipe_or_device_as_material_script_is_one_warning(pipe, caplog):
    load_model(script(pipe("a.material")), Resources())
    assert "a.material cannot be read: it is a pipe or device, not a file" in caplog.text
    load_model(script("/dev/zero"), Resources())
    assert "/dev/zero cannot be read" in caplog.text


def test_a_folder_with_a_pipe_among_its_scripts(pipe, tmp_path):
    (tmp_path / "b.material").write_text(
        "material Mine { technique { pass { diffuse 1 0 0 } } }".replace(" {", "\n{\n")
        .replace("}", "\n}\n"))
    pipe("a.material")
    model = load_model(script(tmp_path), Resources())
    assert model.links[0].visuals[0].material.diffuse == (1, 0, 0, 1)


def test_a_material_script_has_a_largest_size(tmp_path, caplog):
    large = tmp_path / "a.material"
    with large.open("wb") as file:
        file.truncate(LARGEST_SCRIPT + 1)
    load_model(script(large), Resources())
    assert "a.material cannot be read: 4 MB, more than 4" in caplog.text


def test_a_pipe_as_texture(pipe, caplog):
    assert load_image(pipe("a.png"), 100) is None
    assert "texture" in caplog.text and "it is a pipe or device" in caplog.text


@pytest.mark.parametrize("name", ["a.stl", "a.obj", "a.dae", "a.glb"])
def test_a_pipe_as_mesh(pipe, name):
    with pytest.raises(FormatError, match=r"mesh .* it is a pipe or device"):
        load_mesh(Mesh(pipe(name)))


def test_a_pipe_that_a_mesh_names(pipe, tmp_path):
    pipe("a.bin")
    (tmp_path / "a.gltf").write_text("""{"asset": {"version": "2.0"}, "buffers": [{"uri": "a.bin",
        "byteLength": 12}], "scenes": [{"nodes": []}], "scene": 0}""")
    with pytest.raises(FormatError, match="it is a pipe or device"):
        load_mesh(Mesh(str(tmp_path / "a.gltf")))


@pytest.mark.parametrize("shape", [Heightmap, lambda path: ImageExtrusion(path, 1.0, 100, 1.0)])
def test_a_pipe_as_picture_of_the_ground(pipe, shape):
    with pytest.raises(FormatError, match=r"image .* it is a pipe or device"):
        generated_parts(shape(pipe("a.png")))


def test_a_pipe_as_model(pipe, tmp_path, caplog):
    (tmp_path / "w.world").write_text(f"""<sdf version="1.6"><world name="w"><include>
        <uri>file://{pipe("model.sdf")}</uri></include></world></sdf>""")
    assert load_world(tmp_path / "w.world", Resources()).models == ()
    (record,) = caplog.records
    assert "model.sdf" in record.getMessage()


@pytest.mark.parametrize("path, said", [
    ("/nonexistent/x", "/nonexistent/x cannot be read: No such file or directory"),
    ("/tmp", "/tmp cannot be read: it is a folder, not a file"),
    ("a\0b", "cannot be read: .*embedded null"),
])
def test_what_else_is_no_file(path, said):
    with pytest.raises(FormatError, match=said):
        check_file(path, 10)
