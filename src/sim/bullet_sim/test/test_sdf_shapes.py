"""Shapes of SDF that are made, not loaded: heightmaps, polylines, pictures, roads; and meshes."""

import cv2
import numpy as np
import pytest

from bullet_sim.description import (
    Box,
    Cylinder,
    Heightmap,
    ImageExtrusion,
    Mesh,
    Plane,
    Polyline,
    Sphere,
    Strip,
    Visual,
)
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.meshes.generated import dark_rectangles, trapezoids
from bullet_sim.meshes.loading import collision_mesh, load_mesh
from bullet_sim.rendering.scene import link_shape
from bullet_sim.world import World

SQUARE = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
HOLE = ((0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (0.5, 1.5))
BOW_TIE = ((0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0))


@pytest.fixture
def shape(tmp_path):
    """Reads a `<geometry>` with both a visual and a static collision of it, and spawns it."""
    def read(geometry: str, static: bool = True):
        parts = "".join(f'<{tag} name="{tag}"><geometry>{geometry}</geometry></{tag}>'
                        for tag in ("visual", "collision"))
        text = (f'<sdf version="1.6"><model name="m"><static>{int(static)}</static>'
                f'<link name="l">{parts}</link></model></sdf>')
        return load_model(text, Resources([tmp_path], [tmp_path]))
    return read


def only(model):
    """The shape of its one collision, which is that of its one visual."""
    link = model.links[0]
    assert link.collisions[0].geometry == link.visuals[0].geometry
    return link.collisions[0].geometry


def height_at(world: World, x: float, y: float) -> float:
    """Of the first collision below 10 m."""
    fraction = world.cast_rays(np.array([[x, y, 10.0]]), np.array([[x, y, -10.0]])).fraction[0]
    return 10 - 20 * fraction


def write_image(path, pixels) -> str:
    assert cv2.imwrite(str(path), np.array(pixels, np.uint8))
    return str(path)


def test_plain_shapes(shape):
    # conforms: sdf geometry/box/size, sdf geometry/cylinder/radius, sdf geometry/cylinder/length
    # conforms: sdf geometry/sphere/radius, sdf geometry/plane/normal, sdf geometry/plane/size
    assert only(shape("<box><size>1 2 3</size></box>")) == Box((1, 2, 3))
    assert only(shape("<cylinder><radius>2</radius><length>3</length></cylinder>")) == Cylinder(
        2, 3)
    assert only(shape("<sphere><radius>4</radius></sphere>")) == Sphere(4)
    plane = only(shape("<plane><normal>0 1 0</normal><size>2 3</size></plane>"))
    assert plane == Plane((0, 1, 0), (2, 3))


def test_an_empty_geometry_is_nothing_and_no_warning(shape, caplog):
    # conforms: sdf geometry/empty
    assert shape("<empty/>").links[0].visuals == ()
    assert caplog.records == []


def test_mesh_scale_and_submesh(shape, tmp_path):
    # conforms: sdf geometry/mesh/uri, sdf geometry/mesh/scale, sdf geometry/mesh/submesh/name
    # conforms: sdf geometry/mesh/submesh/center
    (tmp_path / "two.obj").write_text(
        "o left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no right\nv 4 0 0\nv 6 0 0\nv 4 2 0\nf 4 5 6\n")
    whole = only(shape("<mesh><uri>model://two.obj</uri><scale>2 1 1</scale></mesh>"))
    assert whole == Mesh(str(tmp_path / "two.obj"), (2, 1, 1))
    part = only(shape("""<mesh><uri>model://two.obj</uri><submesh><name>right</name>
        <center>true</center></submesh></mesh>"""))
    vertices, _ = collision_mesh(part)
    assert vertices.min(axis=0) == pytest.approx((-1, -1, 0))
    assert vertices.max(axis=0) == pytest.approx((1, 1, 0))


def test_heightmap_rises_with_its_image(shape, tmp_path):
    # conforms: sdf geometry/heightmap/uri, sdf geometry/heightmap/size, sdf geometry/heightmap/pos
    ramp = np.tile(np.linspace(0, 255, 65), (65, 1))
    ramp[:8] = 0  # the upper rows are the +y edge
    write_image(tmp_path / "ramp.png", ramp)
    model = shape("""<heightmap><uri>file://ramp.png</uri><size>8 8 2</size><pos>0 0 1</pos>
        </heightmap>""")
    world = World()
    world.spawn(model)
    assert height_at(world, 0.0, 0.0) == pytest.approx(2.0, abs=0.02)
    assert height_at(world, 3.0, -2.0) == pytest.approx(1 + 2 * 7 / 8, abs=0.02)
    assert height_at(world, 3.0, 3.8) == pytest.approx(1.0, abs=0.02)
    world.close()


def test_heightmap_layers_show_by_height(shape, tmp_path, caplog):
    # conforms: sdf geometry/heightmap/texture, sdf geometry/heightmap/blend
    write_image(tmp_path / "ramp.png", np.tile(np.linspace(0, 255, 33), (33, 1)))
    write_image(tmp_path / "mine.png", [[0]])
    model = shape("""<heightmap><uri>file://ramp.png</uri><size>4 4 2</size>
        <texture><diffuse>file://mine.png</diffuse><size>0.5</size></texture>
        <texture><diffuse>file://media/materials/textures/grass_diffusespecular.png</diffuse>
        </texture><blend><min_height>1.5</min_height><fade_dist>1</fade_dist></blend>
        </heightmap>""")
    low, high = load_mesh(only(model))
    assert low.material.texture == str(tmp_path / "mine.png")
    assert np.ptp(low.uv[:, 0]) == pytest.approx(8)  # 4 m in images of 0.5 m
    assert np.ptp(high.uv[:, 1]) == pytest.approx(0.4)  # of 10 m, unless told
    assert high.material.texture is None and high.material.diffuse[1] > high.material.diffuse[0]
    assert len(low.faces) == pytest.approx(3 * len(high.faces), rel=0.1)
    assert caplog.records == []


def test_heightmap_without_its_image_is_flat_ground_and_one_warning(shape, caplog):
    model = shape("<heightmap><uri>model://gone.png</uri><size>4 4 2</size></heightmap>")
    assert only(model) == Heightmap(None, (4, 4, 2))
    vertices, faces = collision_mesh(only(model))
    assert (len(vertices), len(faces), np.ptp(vertices[:, 2])) == (4, 2, 0)
    assert len([r for r in caplog.records if "model://gone.png not found" in r.message]) == 2


def test_sixteen_bits_and_large_images(tmp_path):
    image = np.zeros((600, 600), np.uint16)
    image[:, 300:] = 65535
    cv2.imwrite(str(tmp_path / "deep.png"), image)
    vertices, faces = collision_mesh(Heightmap(str(tmp_path / "deep.png"), (6, 6, 3)))
    assert vertices[:, 2].max() == pytest.approx(3)
    assert 50_000 < len(faces) < 60_000


@pytest.mark.parametrize("outlines, area", [
    ([SQUARE], 4), ([tuple(reversed(SQUARE))], 4), ([SQUARE, HOLE], 3), ([BOW_TIE], 2)])
def test_trapezoids_fill_every_second_gap(outlines, area):
    x, y = np.moveaxis(trapezoids(outlines), -1, 0)
    assert 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum() == pytest.approx(area)


def test_polyline_is_a_solid_with_a_hole(shape):
    # conforms: sdf geometry/polyline/point, sdf geometry/polyline/height
    def outline(points):
        text = "".join(f"<point>{x} {y}</point>" for x, y in points)
        return f"<polyline>{text}<height>0.5</height></polyline>"

    model = shape(outline(SQUARE) + outline(HOLE))
    assert only(model) == Polyline((SQUARE, HOLE), 0.5)
    world = World()
    world.spawn(model)
    assert height_at(world, 0.2, 1.0) == pytest.approx(0.5, abs=0.01)
    assert height_at(world, 1.0, 1.0) < -5
    world.close()
    assert link_shape([Visual("v", only(model))]).radius == pytest.approx(1.436, abs=0.01)


def test_polyline_with_two_points_is_an_error_line_and_left_out(shape, caplog):
    model = shape("<polyline><point>0 0</point><point>1 0</point></polyline>")
    assert model.links[0].collisions == ()
    assert "<polyline>: an outline needs three <point>s or more; left out" in caplog.text


def test_dark_pixels_become_walls(shape, tmp_path):
    # conforms: sdf geometry/image/uri, sdf geometry/image/scale, sdf geometry/image/threshold
    # conforms: sdf geometry/image/height
    plan = np.full((20, 40), 255)
    plan[:5] = 150  # the upper edge is +y
    plan[:, :3] = 60
    write_image(tmp_path / "plan.png", plan)
    model = shape("""<image><uri>file://plan.png</uri><scale>0.1</scale><threshold>100</threshold>
        <height>0.7</height></image>""")
    assert only(model) == ImageExtrusion(str(tmp_path / "plan.png"), 0.1, 100, 0.7)
    world = World()
    world.spawn(model)
    assert height_at(world, -1.85, 0.0) == pytest.approx(0.7, abs=0.01)
    assert height_at(world, 1.0, 0.8) < -5  # 150 is not dark enough
    world.close()


def test_rectangles_cover_a_mask_exactly():
    mask = np.random.default_rng(1).random((30, 40)) < 0.5
    seen = np.zeros(mask.shape, int)
    for left, top, right, bottom in dark_rectangles(mask):
        seen[top:bottom, left:right] += 1
    assert (seen == mask).all()


def test_strip_is_as_wide_as_it_should_be_and_faces_up():
    part, = load_mesh(Strip(((0, 0, 0), (5, 0, 0), (10, 0, 1)), 2.0))
    assert (part.vertices[:, 1].min(), part.vertices[:, 1].max()) == (-1, 1)
    assert (part.normals[:, 2] > 0.9).all()
    assert part.uv[:, 1].max() == pytest.approx((5 + 26 ** 0.5) / 2)


@pytest.mark.parametrize("geometry", [
    "<polyline><point>0 0</point><point>1 0</point><point>2 0</point></polyline>",
    "<image><uri>file://dark.png</uri><scale>0</scale></image>",
])
def test_what_encloses_nothing_is_left_out_with_a_warning(shape, tmp_path, geometry, caplog):
    write_image(tmp_path / "dark.png", [[0, 0]])
    world = World()
    assert world.spawn(shape(geometry)).links["l"]
    assert "visual visual is left out" in caplog.text
    world.close()


def test_lengths_that_cannot_be_squared_are_left_out(shape, caplog):
    model = shape(
        "<polyline><point>0 0</point><point>1e200 0</point><point>1 1</point></polyline>")
    assert model.links[0].collisions == ()
    assert "<polyline> <point>: 1e+200 is too large" in caplog.text
