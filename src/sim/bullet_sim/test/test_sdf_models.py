"""Elements of SDF models: includes, links, visuals, materials, lights; old names."""

import pytest

from bullet_sim.description import Box, Material
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.ogre import named_materials
from bullet_sim.formats.resources import DATA_FOLDER, Resources
from bullet_sim.rendering.scene import link_shape

BOX = '<geometry><box><size>1 1 1</size></box></geometry>'


@pytest.fixture
def resources(tmp_path):
    return Resources([tmp_path / "models", DATA_FOLDER / "models"], [tmp_path, DATA_FOLDER])


@pytest.fixture
def load(tmp_path, resources):
    def read(body: str, version: str = "1.6"):
        file = tmp_path / "test.world"
        file.write_text(f'<sdf version="{version}"><world name="w">{body}</world></sdf>')
        return load_world(file, resources)
    return read


@pytest.fixture
def material(resources):
    """Reads a `<material>` of a visual."""
    def read(body: str) -> Material | None:
        text = f"""<sdf version="1.7"><model name="m"><link name="l"><visual name="v">{BOX}
            <material>{body}</material></visual></link></model></sdf>"""
        return load_model(text, resources).links[0].visuals[0].material
    return read


def put(path, text: str = ""):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def put_model(tmp_path, name: str, body: str) -> None:
    put(tmp_path / "models" / name / "model.config",
        '<model><name>x</name><sdf version="1.6">model.sdf</sdf></model>')
    put(tmp_path / "models" / name / "model.sdf",
        f'<sdf version="1.6"><model name="{name.split("/")[-1]}">{body}</model></sdf>')


# --- includes and nesting

def test_include_and_its_overrides(tmp_path, load):
    # conforms: sdf world/include, sdf include/uri, sdf include/name, sdf include/pose
    # conforms: sdf include/static, sdf include/plugin, sdf model/include
    put_model(tmp_path, "shelf/crate",
              f'<link name="l"><collision name="c">{BOX}</collision></link>')
    put_model(tmp_path, "stack", """<link name="base"/><include><uri>model://shelf/crate</uri>
        <name>upper</name><pose>0 0 1 0 0 0</pose></include>
        <joint name="j" type="fixed"><parent>base</parent><child>upper::l</child></joint>""")
    crate, stack = load("""<include><uri>model://shelf/crate</uri><name>mine</name>
        <pose>1 2 3 0 0 0</pose><static>1</static><plugin name="p" filename="libx.so"/></include>
        <include><uri>model://stack</uri></include>""").models
    assert (crate.name, crate.pose.position, crate.static) == ("mine", (1, 2, 3), True)
    assert crate.plugins[0].filename == "libx.so"
    assert [link.name for link in stack.links] == ["base", "upper::l"]
    assert stack.links[1].pose.position == (0, 0, 1)


def test_a_bomb_of_includes_ends(tmp_path, load, caplog):
    for depth in range(14):
        put_model(tmp_path, f"m{depth}", "<link name='l'/>" + "".join(
            f"<include><uri>model://m{depth + 1}</uri><name>{side}</name></include>"
            for side in "ab"))
    put_model(tmp_path, "m14", "<link name='l'/>")
    load("<include><uri>model://m0</uri></include>")
    assert [record.message for record in caplog.records] == [
        "more than 2000 <include>s; the rest is left out"]


@pytest.mark.parametrize("uri, message", [
    ("model://gone", "model://gone not found (searched: {0}/models, "),
    ("https://fuel.example/x", "nothing is downloaded; put the files into a folder of "
                               "GAZEBO_MODEL_PATH and write model://NAME"),
    ("model://" + "x" * 5000, "not found"),
    ("file://~nobody-of-that-name/x", "not found"),
    ("model://" + "../" * 30 + "etc/passwd", "is not well-formed XML"),
    ("", "no <uri>; write <uri>model://NAME</uri>"),
])
def test_what_cannot_be_included_is_one_error_line(load, caplog, tmp_path, uri, message):
    # conforms: uri http://
    world = load(f"""<include><uri>{uri}</uri></include>
        <include><uri>model://sun</uri></include>""")
    assert [light.name for light in world.lights] == ["sun"]
    assert len(caplog.records) == 1 and "\n" not in caplog.text.strip()
    assert message.format(tmp_path) in caplog.text


# --- models and links

def test_what_a_model_says(load):
    # conforms: sdf world/model, sdf model/static, sdf model/self_collide, sdf model/pose
    # conforms: sdf model/link, sdf model/joint, sdf model/model, sdf model/plugin
    # conforms: sdf world/plugin, sdf world/gravity, sdf world/magnetic_field
    world = load("""<gravity>0 0 -1</gravity><magnetic_field>1 2 3</magnetic_field>
        <plugin name="w" filename="libw.so"/>
        <model name="m"><static>true</static><self_collide>1</self_collide>
        <pose>1 2 3 0 0 0</pose><link name="a"/><model name="n"><link name="b"/></model>
        <joint name="j" type="fixed"><parent>a</parent><child>n::b</child></joint>
        <plugin name="p" filename="libp.so"/></model>""")
    assert (world.gravity, world.magnetic_field) == ((0, 0, -1), (1, 2, 3))
    model = world.models[0]
    assert (model.static, model.self_collide, model.pose.position) == (True, True, (1, 2, 3))
    assert [link.name for link in model.links] == ["a", "n::b"] and model.joints[0].name == "j"
    assert [p.filename for p in (*world.plugins, *model.plugins)] == ["libw.so", "libp.so"]


def test_what_a_link_says(load):
    # conforms: sdf link/pose, sdf link/inertial, sdf inertial/mass, sdf inertial/pose
    # conforms: sdf inertial/inertia, sdf link/gravity, sdf link/velocity_decay, sdf link/sensor
    # conforms: sdf link/light, sdf collision/pose, sdf collision/geometry
    # conforms: sdf collision/laser_retro
    link = load(f"""<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose><gravity>0</gravity>
        <inertial><mass>3</mass><pose>0 1 0 0 0 0</pose><inertia><ixx>2</ixx><ixy>.1</ixy>
        </inertia></inertial><velocity_decay><linear>.1</linear><angular>.2</angular>
        </velocity_decay><sensor name="s" type="imu"/><light name="x" type="spot"/>
        <collision name="c"><pose>0 0 1 0 0 0</pose>{BOX}<laser_retro>9</laser_retro></collision>
        </link></model>""").models[0].links[0]
    assert (link.pose.position, link.gravity) == ((1, 0, 0), False)
    assert (link.inertial.mass, link.inertial.pose.position) == (3, (0, 1, 0))
    assert link.inertial.inertia[:2] == (2, 0.1)
    assert (link.linear_damping, link.angular_damping) == (0.1, 0.2)
    assert (link.sensors[0].type, link.lights[0].type) == ("imu", "spot")
    collision = link.collisions[0]
    assert (collision.pose.position, collision.laser_retro) == ((0, 0, 1), 9)
    assert collision.geometry == Box((1, 1, 1))


def test_names_of_the_oldest_files():
    # conforms: SDF 1.2 to 1.7/gazebo root, SDF 1.2 to 1.7/origin pose
    # conforms: SDF 1.2 to 1.7/link damping
    text = """<gazebo version="1.2"><model name="m"><link name="l">
        <origin pose="1 2 3 0 0 0"/><damping><linear>0.5</linear></damping>
        <visual name="v"><geometry><sphere><radius>1</radius></sphere></geometry>
        <material><script>Gazebo/Red</script></material></visual></link></model></gazebo>"""
    link = load_model(text, Resources()).links[0]
    assert link.pose.position == (1, 2, 3)
    assert link.linear_damping == 0.5
    assert link.visuals[0].material == named_materials()["Gazebo/Red"]


def test_numbers_on_any_white_space(load):
    # conforms: sdf pose
    world = load("<model name='m'><pose>1 -0\n 2\t0 -0 0\n</pose><link name='l'/></model>")
    assert world.models[0].pose.position == (1, 0, 2)


# --- what is seen

def test_what_a_visual_says(load):
    # conforms: sdf visual/geometry, sdf visual/pose, sdf visual/material, sdf visual/transparency
    # conforms: sdf visual/plugin
    visual = load(f"""<model name="m"><link name="l"><visual name="v"><pose>0 0 1 0 0 0</pose>
        {BOX}<transparency>0.5</transparency><material><diffuse>1 0 0 1</diffuse></material>
        <plugin name="p" filename="libv.so"/></visual></link></model>
        """).models[0].links[0].visuals[0]
    assert (visual.geometry, visual.pose.position) == (Box((1, 1, 1)), (0, 0, 1))
    assert (visual.transparency, visual.material.diffuse) == (0.5, (1, 0, 0, 1))
    assert visual.plugins[0].filename == "libv.so"


def test_colours_and_light_of_a_material(material):
    # conforms: sdf material/ambient, sdf material/diffuse, sdf material/specular
    # conforms: sdf material/emissive, sdf material/lighting, sdf material/shininess
    read = material("""<ambient>.1 0 0 1</ambient><diffuse>.2 0 0</diffuse>
        <specular>.3 0 0 1</specular><emissive>.4 0 0 1</emissive><lighting>0</lighting>
        <shininess>7</shininess><shader type="normal_map_tangent_space"/>""")
    assert [c[0] for c in (read.ambient, read.diffuse, read.specular, read.emissive)] == [
        .1, .2, .3, .4]
    assert (read.diffuse[3], read.lighting, read.shininess) == (1, False, 7)
    assert material("") is None


def test_colours_written_beside_a_script_win(material):
    # conforms: sdf material/script/name
    script = """<script><uri>file://media/materials/scripts/gazebo.material</uri>
        <name>Gazebo/Grey</name></script>"""
    grey = named_materials()["Gazebo/Grey"]
    assert material(script) == grey
    changed = material(script + "<ambient>1 0 0 1</ambient>")
    assert (changed.ambient, changed.diffuse) == ((1, 0, 0, 1), grey.diffuse)


def test_albedo_map_is_the_texture(material, tmp_path, caplog):
    # conforms: sdf material/pbr/metal/albedo_map, sdf material/pbr/specular/albedo_map
    image = put(tmp_path / "models/wall/materials/textures/wall.png")
    uri = "model://wall/materials/textures/wall.png"
    for workflow in ("metal", "specular"):
        body = f"<pbr><{workflow}><albedo_map>{uri}</albedo_map></{workflow}></pbr>"
        assert material(body).texture == str(image)
    assert material("<pbr><metal><albedo_map>gone.png</albedo_map></metal></pbr>") is None
    assert "albedo_map gone.png not found" in caplog.text


def test_double_sided_is_seen_from_behind(load):
    # conforms: sdf material/double_sided
    def shape(sides: int):
        visuals = load(f"""<model name="m"><link name="l"><visual name="v"><geometry><plane/>
            </geometry><material><diffuse>1 0 0 1</diffuse><double_sided>{sides}</double_sided>
            </material></visual></link></model>""").models[0].links[0].visuals
        return link_shape(visuals).parts[0]

    one, two = shape(0), shape(1)
    assert len(two.faces) == 2 * len(one.faces)
    assert {float(z) for z in two.normals[:, 2]} == {1.0, -1.0}


def test_scripts_import_inherit_and_put_in_textures(material, tmp_path):
    # conforms: OGRE material/inheritance, OGRE material/import, OGRE material/texture_alias
    # conforms: OGRE material/cull_hardware none, sdf material/script/uri
    scripts = tmp_path / "models/a/materials/scripts"
    put(scripts.parent / "textures/mine.png")
    put(scripts / "base.material", """material Base { technique { pass { diffuse 0 1 0
        cull_hardware none
        texture_unit { texture_alias Skin
          texture other.png } } } }""")
    put(scripts / "own.material", """import * from "base.material"
        material Own : Base { set_texture_alias Skin mine.png
          technique { pass { ambient 1 0 0 } } }
        material Loud : Gazebo/Blue { technique { pass { ambient 1 0 0 } } }""")
    def named(name):
        uri = "model://a/materials/scripts/own.material"
        return material(f"<script><uri>{uri}</uri><name>{name}</name></script>")
    own = named("Own")
    assert (own.ambient, own.diffuse, own.double_sided) == ((1, 0, 0, 1), (0, 1, 0, 1), True)
    assert own.texture == str(scripts.parent / "textures/mine.png")
    assert named("Loud").diffuse == (0, 0, 1, 1)


def test_light(load):
    # conforms: sdf light/pose, sdf light/diffuse, sdf light/specular, sdf light/direction
    # conforms: sdf light/attenuation/range, sdf light/attenuation/constant
    # conforms: sdf light/attenuation/linear, sdf light/attenuation/quadratic
    # conforms: sdf light/spot/inner_angle, sdf light/spot/outer_angle, sdf light/spot/falloff
    light = load("""<light name="x" type="spot"><pose>1 2 3 0 0 0</pose><diffuse>.1 0 0 1</diffuse>
        <specular>.2 0 0 1</specular><direction>1 0 0</direction><attenuation><range>20</range>
        <constant>.3</constant><linear>.4</linear><quadratic>.5</quadratic></attenuation>
        <spot><inner_angle>.6</inner_angle><outer_angle>.7</outer_angle><falloff>2</falloff></spot>
        </light>""").lights[0]
    assert (light.pose.position, light.direction) == ((1, 2, 3), (1, 0, 0))
    assert (light.diffuse[0], light.specular[0]) == (.1, .2)
    assert (light.range, light.constant, light.linear, light.quadratic) == (20, .3, .4, .5)
    assert (light.inner_angle, light.outer_angle, light.falloff) == (.6, .7, 2)


def test_what_is_silently_accepted(load, caplog):
    load(f"""<gui fullscreen="0"><camera name="user"><pose>0 0 5 0 0 0</pose></camera></gui>
        <audio/><wind/><atmosphere type="adiabatic"/><model name="m"><meta/>
        <allow_auto_disable>1</allow_auto_disable><enable_wind>0</enable_wind>
        <link name="l"><must_be_base_link>1</must_be_base_link><enable_wind>0</enable_wind>
        <audio_sink/><battery name="b"/><visual name="v"><meta><layer>1</layer></meta>
        <cast_shadows>0</cast_shadows><laser_retro>1</laser_retro>{BOX}</visual>
        <collision name="c"><max_contacts>3</max_contacts>{BOX}<surface><bounce/><friction><ode/>
        <torsional/></friction><contact><ode/></contact></surface></collision></link></model>
        <road:own/>""")
    assert caplog.records == []


@pytest.mark.parametrize("tag", ["gripper", "urdf"])
def test_what_is_left_out_of_a_model_is_one_warning(load, caplog, tag):
    (model,) = load(f'<model name="m"><link name="l"/><{tag}/><{tag}/></model>').models
    assert [link.name for link in model.links] == ["l"]
    assert [record.getMessage() for record in caplog.records] == [
        f"model 'm': <{tag}> is not supported, left out"]
