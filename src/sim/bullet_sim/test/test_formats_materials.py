"""Materials: Gazebo's names, OGRE scripts, colours written in SDF."""

import pytest

from bullet_sim.description import Material
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.ogre import named_materials, parse_script, to_material
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.sdf.actor import CLOTHES, SKIN
from bullet_sim.formats.sdf.generated_shapes import GROUNDS, SOIL

NO_FILES = Resources()
SCRIPT = """
import * from "base.material" // a comment
/* material hidden { } */
material Base
{
  technique
  {
    pass
    {
      ambient 0.1 0.2 0.3
      diffuse 0.4 0.5 0.6 0.7
      specular 0.1 0.1 0.1 1 12.5
      emissive 0.5 0 0
      lighting off
      texture_unit { texture wall.png
        scale 2 4 }
      texture_unit { texture second.png }
    }
    pass { diffuse 1 1 1 }
  }
  technique { pass { ambient 1 1 1 } }
}
material "Derived One" : Base
{
  receive_shadows off
  technique { pass { diffuse 1 0 0 } }
}
"""
TEXTURED = "material {} {{ technique {{ pass {{ texture_unit {{ texture {} }} }} }} }}"
GREY = (0.5, 0.5, 0.5)
ORANGE = (1, 0.5088, 0.0468)
COLOURS = {
    "Grey": (0.7, 0.7, 0.7), "DarkGrey": (0.175, 0.175, 0.175), "White": (1, 1, 1),
    "FlatBlack": (0.1, 0.1, 0.1), "Black": (0, 0, 0), "Red": (1, 0, 0),
    "RedBright": (0.87, 0.26, 0.07), "Green": (0, 1, 0), "Blue": (0, 0, 1), "SkyBlue": (0, 0, 1),
    "Yellow": (1, 1, 0), "ZincYellow": (0.9725, 0.9529, 0.2078), "DarkYellow": (0.7, 0.7, 0),
    "Purple": (1, 0, 1), "Turquoise": (0, 1, 1), "Orange": ORANGE, "Indigo": (0.33, 0, 0.5),
    "Gold": (0.8, 0.64869, 0.120759), "Pioneer2Body": (0.681, 0.0009, 0.0009),
    "JointAnchor": (1, 1, 1), "LightBlueLaser": (0.5, 0.5, 1, 0.4), "BlueLaser": (0, 0, 1, 0.4),
    "RedGlow": (1, 0, 0), "GreenGlow": (0, 1, 0), "BlueGlow": (0, 0, 1), "YellowGlow": (1, 1, 0),
    "PurpleGlow": (1, 0, 1), "TurquoiseGlow": (0, 1, 1), "WhiteGlow": (1, 1, 1),
    "RedTransparent": (1, 0, 0, 0.5), "GreenTransparent": (0, 1, 0, 0.5),
    "BlueTransparent": (0, 0, 1, 0.5), "YellowTransparent": (1, 1, 0, 0.5),
    "GreyTransparent": (*GREY, 0.5), "RedTransparentOverlay": (1, 0, 0, 0.5),
    "GreenTransparentOverlay": (0, 1, 0, 0.5), "BlueTransparentOverlay": (0, 0, 1, 0.5),
    "OrangeTransparentOverlay": (*ORANGE, 0.8),
    "DarkOrangeTransparentOverlay": (0.6, 0.305, 0.028, 0.8),
    "DarkMagentaTransparent": (0.6, 0, 0.6, 0.5), "OrangeTransparent": (1, 0.44, 0, 0.4),
    "LightOn": (0, 1, 0), "LightOff": (1, 0, 0),
}
PICTURED = """WoodFloor CeilingTiled PaintedWall WoodPallet Wood Bricks WindowFrame Road Residential
    Tertiary Pedestrian Footway Motorway Lanes_6 Trunk Lanes_4 Primary Lanes_2 Secondary Lane_1
    Steps PioneerBody CoM CloudySky GreyGradientSky""".split()


@pytest.mark.parametrize("name", sorted(named_materials()))
def test_every_named_material_is_a_material(name):
    material = named_materials()[name]
    for colour in (material.ambient, material.diffuse, material.specular, material.emissive):
        assert len(colour) == 4 and all(0 <= part <= 1 for part in colour)


@pytest.mark.parametrize("name, redder", [
    ("vrc/grey_wall", 0), ("vrc/grass", -1), ("vrc/asphalt", 0), ("vrc/mud", 1),
    ("Rubble/Brick", 1), ("Kitchen/Cabinet", 1), ("RoboCup/Carpet", -1), ("Block/Blue", 0),
    ("youbot/Orange", 1)])
def test_names_of_other_scripts_have_their_colour_without_the_script(name, redder, caplog):
    uri = "<uri>model://somewhere/materials/scripts</uri>"
    model = load_model(f"""<sdf version="1.6"><model name="m"><link name="l"><visual name="v">
        <geometry><sphere/></geometry><material><script>{uri}<name>{name}</name></script></material>
        </visual></link></model></sdf>""", NO_FILES)
    red, green = model.links[0].visuals[0].material.diffuse[:2]
    assert abs(red - green) <= 0.1 if redder == 0 else (red - green) * redder > 0
    assert not caplog.records


@pytest.mark.parametrize("colour", [
    *GROUNDS.values(), SOIL, *(part for material in (CLOTHES, SKIN)
                               for part in (material.ambient, material.diffuse))])
def test_our_own_colours_are_colours(colour):
    assert len(colour) == 4 and colour[3] == 1 and all(0 <= part <= 1 for part in colour)


def test_a_statement_without_a_value_sets_nothing():
    script = parse_script("material A { technique { pass { ambient\n diffuse 1 0 0 } } }")
    assert to_material("A", script, lambda file: file) == Material(diffuse=(1, 0, 0, 1))


@pytest.mark.parametrize("picture", ["wall.png", "pass", "technique"])
def test_a_picture_may_have_any_name(picture):
    script = parse_script(TEXTURED.format("A", picture))
    assert to_material("A", script, lambda file: f"/t/{file}").texture == f"/t/{picture}"


def test_what_follows_a_pictures_name_is_of_no_matter():
    script = parse_script(TEXTURED.format("A", "wall.png 2d unlimited"))
    assert to_material("A", script, lambda file: file).texture == "wall.png"


@pytest.mark.parametrize("alias, texture", [
    ("texture_alias wall", "brick.png"), ("texture_alias wall painted", "brick.png"),
    ("texture_alias roof", "wall.png"), ("texture_alias roof wall", "wall.png"),
    ("", "brick.png")])
def test_a_material_that_inherits_may_replace_a_picture_by_its_alias(alias, texture):
    script = parse_script(TEXTURED.format("A", f"wall.png\n{alias}\n")
                          + "\nmaterial B : A { set_texture_alias wall brick.png }")
    assert to_material("A", script, lambda file: file).texture == "wall.png"
    assert to_material("B", script, lambda file: file).texture == texture


def test_some_of_gazebos_values():
    # conforms: materials Gazebo/*
    named = named_materials()
    assert (named["Gazebo/Grey"].ambient, named["Gazebo/Grey"].diffuse) == (
        (0.3, 0.3, 0.3, 1), (0.7, 0.7, 0.7, 1))
    assert named["Gazebo/Orange"].diffuse == (1, 0.5088, 0.0468, 1)
    assert named["Gazebo/RedTransparent"].diffuse[3] == 0.5
    assert named["Gazebo/GreenGlow"].emissive == (0, 1, 0, 1)


def test_ogre_script():
    base = to_material("Base", parse_script(SCRIPT), lambda file: f"/textures/{file}")
    assert base == Material(
        ambient=(0.1, 0.2, 0.3, 1), diffuse=(0.4, 0.5, 0.6, 0.7), specular=(0.1, 0.1, 0.1, 1),
        emissive=(0.5, 0, 0, 1), shininess=12.5, texture="/textures/wall.png",
        texture_scale=(2, 4), lighting=False)


def test_ogre_inheritance():
    derived = to_material("Derived One", parse_script(SCRIPT), lambda file: file)
    assert derived.diffuse == (1, 0, 0, 1)
    assert derived.ambient == (0.1, 0.2, 0.3, 1)
    assert derived.texture == "wall.png"


@pytest.mark.parametrize("text, message", [
    ("material a { technique {", "material 'a': a '}' is missing"),
    ("material a technique", "material 'a technique': expected '{' after its name"),
])
def test_broken_scripts(text, message):
    with pytest.raises(FormatError, match=message.replace("{", r"\{").replace("}", r"\}")):
        parse_script(text)


def test_word_for_a_number():
    materials = parse_script("material a { technique { pass { diffuse red 0 0 } } }")
    with pytest.raises(FormatError, match="material 'a': diffuse 'red 0 0'"):
        to_material("a", materials, lambda file: file)


def visual_with(material: str, resources: Resources = NO_FILES) -> Material | None:
    shape = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    model = load_model(f"""<sdf version="1.6"><model name="m"><link name="l">
    <visual name="v">{shape}
        <material>{material}</material></visual></link></model></sdf>""", resources)
    return model.links[0].visuals[0].material


def test_colours_in_sdf():
    material = visual_with(
        "<ambient>1 0 0</ambient><diffuse>0 1 0 0.5</diffuse><lighting>0</lighting>")
    assert (material.ambient, material.diffuse) == ((1, 0, 0, 1), (0, 1, 0, 0.5))
    assert not material.lighting


def test_colours_win_over_the_script():
    material = visual_with("""<script><uri>file://media/materials/scripts/gazebo.material</uri>
        <name>Gazebo/Red</name></script><ambient>0 0 1 1</ambient>""")
    assert (material.ambient, material.diffuse) == ((0, 0, 1, 1), (1, 0, 0, 1))


@pytest.mark.parametrize("name", COLOURS)
def test_plain_materials_by_name(name):
    # conforms: Gazebo/* materials, Gazebo/* materials/plain colours
    material = visual_with(f"<script><name>Gazebo/{name}</name></script>")
    assert material.diffuse == pytest.approx((*COLOURS[name], 1)[:4])
    assert (sum(material.emissive[:3]) > 0) == name.endswith(("Glow", "LightOn", "LightOff"))
    assert material.lighting == ("Overlay" not in name and name != "JointAnchor")


@pytest.mark.parametrize("name", PICTURED)
def test_pictured_materials_have_a_plain_colour(name, caplog):
    # conforms: Gazebo/* materials/textures
    assert visual_with(f"<script><name>Gazebo/{name}</name></script>").diffuse[3] == 1
    assert not caplog.records


def test_no_material_is_missed():
    # conforms: Gazebo/* materials
    of_gazebo = {name for name in named_materials() if name.startswith("Gazebo/")}
    assert of_gazebo == {f"Gazebo/{name}" for name in [*COLOURS, *PICTURED]}


def test_unknown_name_is_one_warning_and_the_default(caplog):
    # conforms: Gazebo/* materials/unknown names
    assert visual_with("<script><name>Gazebo/Gren</name></script>") is None
    assert len(caplog.records) == 1
    assert "material 'Gazebo/Gren' not found" in caplog.text


def test_missing_texture_is_one_warning_with_folders(tmp_path, caplog):
    (tmp_path / "a.material").write_text(TEXTURED.format("a", "gone.png"))
    material = visual_with(f"<script><uri>file://{tmp_path}</uri><name>a</name></script>")
    assert material == Material()
    assert len(caplog.records) == 1
    assert "texture gone.png not found" in caplog.text and str(tmp_path) in caplog.text


@pytest.mark.parametrize("script", [TEXTURED.format("a", "x" * 5000),
                                    f"import * from {'x' * 5000}\n" + TEXTURED.format("a", "b")])
def test_a_name_too_long_for_a_file_is_one_short_warning(tmp_path, caplog, script):
    (tmp_path / "a.material").write_text(script)
    material = visual_with(f"<script><uri>file://{tmp_path}</uri><name>a</name></script>")
    assert material.texture is None
    (record,) = caplog.records
    assert "not found" in record.getMessage() and len(record.getMessage()) < 1000


def test_missing_script_folder_is_in_the_warning(tmp_path, caplog):
    uri = f"model://gone/{tmp_path.name}"
    visual_with(f"<script><uri>{uri}</uri><name>a</name></script>", Resources([tmp_path]))
    assert len(caplog.records) == 1
    assert uri in caplog.text and str(tmp_path) in caplog.text


def test_scripts_of_media_folders_are_known_everywhere(tmp_path):
    scripts = tmp_path / "media/materials/scripts"
    scripts.mkdir(parents=True)
    (tmp_path / "media/materials/textures").mkdir()
    (tmp_path / "media/materials/textures/t.png").write_bytes(b"")
    (scripts / "mine.material").write_text(TEXTURED.format("Mine/X", "t.png"))
    material = visual_with("<script><name>Mine/X</name></script>", Resources([], [tmp_path]))
    assert material.texture == str(tmp_path / "media/materials/textures/t.png")
