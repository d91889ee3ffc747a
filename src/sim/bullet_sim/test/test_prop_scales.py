"""Worlds that Gazebo saved name the meshes of its models with a `<scale>`, which is not always 1
for a thing as large as it is included: each of our stand-ins knows its own. They name what was
included by the models' own names, which are not always the folders'.
"""

import numpy as np
import pytest
from prop_models import RESOURCES, bounds, load

from bullet_sim.description import Cylinder
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.prop_shapes import FILE, PropMesh, read_prop_meshes
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.pose import Pose
from bullet_sim.world import World

NATIVE = {  # <scale> of the mesh in the model's own file, and pose of its link there
    "construction_cone": ("10 10 10", "0 0 0"), "cube_20k": ("0.5 0.5 0.5", "0 0 0.5"),
    "dumpster": ("1.5 1.5 1.5", "0 0 0"), "house_1": ("1.5 1.5 1.5", "0 0 0"),
    "house_2": ("1.5 1.5 1.5", "0 0 0"), "house_3": ("1.5 1.5 1.5", "0 0 0"),
    "lamp_post": ("3 3 3", "0 0 0"), "brick_box_3x1x3": ("3 1 3", "0 0 1.5"),
    "speed_limit_sign": ("10 10 10", "0 0 0"), "fast_food": ("3 3 2", "0 0 3.15931296"),
    "suv": ("0.06 0.06 0.06", "0 0 0"), "bus": ("0.01 0.01 0.01", "0 0 0"),
    "ambulance": ("0.0254 0.0254 0.0254", "0 0 0"), "fire_hydrant": ("1 1 1", "0 0 0"),
}


def saved(folder: str, scale: str, link_pose: str = "0 0 0", part_pose: str = "0 0 0") -> str:
    """A model as Gazebo's window writes it."""
    part = (f"<pose frame=''>{part_pose} 0 -0 0</pose><geometry><mesh>"
            f"<uri>model://{folder}/meshes/{folder}.dae</uri><scale>{scale}</scale></mesh>"
            "</geometry>")
    return f"""<sdf version='1.6'><model name='thing'><link name='link'>
      <pose frame=''>{link_pose} 0 -0 0</pose>
      <inertial><mass>1</mass></inertial>
      <collision name='collision'>{part}<max_contacts>10</max_contacts></collision>
      <visual name='visual'>{part}</visual><self_collide>0</self_collide></link></model></sdf>"""


def corners(text: str) -> np.ndarray:
    return np.array(bounds(load_model(text, RESOURCES)))


@pytest.mark.parametrize("folder", NATIVE)
def test_saved_at_its_own_scale_it_is_the_included_model(folder):
    assert corners(saved(folder, *NATIVE[folder])) == pytest.approx(
        np.array(bounds(load(folder))), abs=1e-6)


@pytest.mark.parametrize("folder, scale, times", [
    ("construction_cone", "5 5 5", (0.5, 0.5, 0.5)), ("cube_20k", "1 1 1", (2, 2, 2)),
    ("construction_cone", "20 10 5", (2, 1, 0.5)), ("dumpster", "3 1.5 1.5", (2, 1, 1)),
    ("jersey_barrier", "2 2 2", (2, 2, 2)), ("brick_box_3x1x3", "3 1 6", (1, 1, 2)),
    ("lamp_post", "-3 3 3", (1, 1, 1)),
])
def test_another_scale_makes_it_as_much_larger(folder, scale, times):
    low, high = corners(saved(folder, scale))
    own_low, own_high = corners(saved(folder, NATIVE.get(folder, ("1 1 1",))[0]))
    assert high[1:] - low[1:] == pytest.approx((own_high - own_low)[1:] * times[1:], rel=0.5)
    if len(set(times)) == 1:  # round shapes stay round, by their greatest factor
        assert high - low == pytest.approx((own_high - own_low) * times, rel=1e-6)


def test_a_wall_stretched_along_one_axis_keeps_the_others():
    low, high = corners(saved("brick_box_3x1x3", "6 1 3", "0 0 1.5"))
    assert low == pytest.approx((-3, -0.5, 0)) and high == pytest.approx((3, 0.5, 3))


def test_a_mirrored_lamp_hangs_on_the_other_side():
    _, usual = corners(saved("lamp_post", "3 3 3"))
    low, _ = corners(saved("lamp_post", "3 -3 3"))
    _, away = corners(saved("lamp_post", "3 3 3", part_pose="0 0 0"))
    assert usual[1] == pytest.approx(away[1]) and usual[1] < 0.5
    assert corners(saved("lamp_post", "3 -3 3"))[1][1] > 1.5 and low[1] > -0.5


def test_cones_and_cubes_of_a_saved_world_stand_on_the_ground(tmp_path):
    """Half-size cones, a cube and a dumpster beside each other: none falls for ever."""
    things = {"Construction Cone": ("construction_cone", "5 5 5"),
              "cube": ("cube_20k", "0.5 0.5 0.5"),
              "dumpster": ("dumpster", "1.5 1.5 1.5"), "lamp": ("lamp_post", "3 3 3")}
    models = "".join(
        saved(folder, scale).split(">", 1)[1].removesuffix("</sdf>")
        .replace("'thing'>", f"'{name}'><pose>{6 * number} 0 1 0 0 0</pose>")
        for number, (name, (folder, scale)) in enumerate(things.items()))
    file = tmp_path / "saved.world"
    file.write_text(f"<sdf version='1.6'><world name='default'><include><uri>model://ground_plane"
                    f"</uri></include>{models}</world></sdf>")
    world = World(load_world(file, RESOURCES))
    world.step(round(2.0 / world.timestep))
    for name in things:
        low, _ = bounds(world.models[name].description)
        assert world.models[name].pose.position[2] + low[2] > -0.05, name
    world.close()


def test_a_cone_is_half_as_wide_at_half_its_scale():
    link = load_model(saved("construction_cone", "5 5 5"), RESOURCES).links[0]
    radii = [part.geometry.radius for part in link.collisions
             if isinstance(part.geometry, Cylinder)]
    assert radii == pytest.approx([0.085, 0.0725, 0.0575, 0.0425, 0.025])


def test_a_part_of_an_arm_is_that_link_alone():
    text = saved("simple_arm", "1 1 1").replace("<link name='link'>", "<link name='arm_base'>")
    whole = load("simple_arm")
    own = next(link for link in whole.links if link.name == "arm_base")
    link = load_model(text, RESOURCES).links[0]
    assert [part.geometry for part in link.collisions] == [
        part.geometry for part in own.collisions]


def test_each_scale_is_one_of_a_model_that_is_here():
    assert read_prop_meshes(FILE).keys() <= {
        path.name for path in (DATA_FOLDER / "models").iterdir()}


@pytest.mark.parametrize("written, said", [
    ("size = [1, 1, 1]", "has an unknown key 'size'; there are: scale, at"),
    ("scale = [1, 1]", "scale = \\[1, 1\\] is not 3 numbers"),
    ("scale = [1, 0, 1]", "is not 3 numbers other than 0"), ("scale = 2", "is not 3 numbers"),
    ('at = ["a", 0, 0]', "is not 3 or 6 numbers"),
])
def test_a_wrong_line_of_the_table_is_an_error_that_names_it(tmp_path, written, said):
    file = tmp_path / "meshes.toml"
    file.write_text(f"[cone]\n{written}\n")
    with pytest.raises(FormatError, match=rf"meshes.toml: \[cone\] .*{said}"):
        read_prop_meshes(file)


def test_a_mesh_that_only_lies_elsewhere_is_as_large_as_our_shapes(tmp_path):
    file = tmp_path / "meshes.toml"
    file.write_text("[cone]\nat = [0, 0, 1]\n")
    assert read_prop_meshes(file) == {"cone": PropMesh((1.0, 1.0, 1.0), Pose((0.0, 0.0, 1.0)))}


def test_what_loses_its_collisions_is_told_link_by_link(caplog):
    """The mesh is named once, and each further link that has nothing else to touch with, too."""
    mesh = "<geometry><mesh><uri>model://gone/rock.dae</uri></mesh></geometry>"
    link = ("<link name='{}'><visual name='v'>" + mesh + "</visual><collision name='c'>" + mesh
            + "</collision></link>")
    load_model(f"<sdf version='1.6'><model name='rocks'>{link.format('one')}{link.format('two')}"
               "</model></sdf>", RESOURCES)
    first, second = (record.getMessage() for record in caplog.records)
    assert "model 'rocks', link 'one', collision 'c': mesh" in first and "not found" in first
    assert second == ("model 'rocks', link 'two': nothing collides with it, and it falls for ever "
                      "if nothing holds it: model://gone/rock.dae not found")


def test_round_the_origin_of_the_willow_garage_there_is_room():
    """Robots are spawned there, wide ones too, and drive off in any direction."""
    walls = World(load_world(DATA_FOLDER / "worlds/willowgarage.world", RESOURCES))
    angles = np.linspace(0, 2 * np.pi, 72, endpoint=False)
    out = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    for height in (0.1, 0.5, 1.0):
        start = np.full((72, 3), (0.0, 0.0, height))
        assert walls.cast_rays(start, start + 10 * out).fraction.min() * 10 > 4.0
    walls.close()


OWN = {  # facts of the public model files of that address, newest version
    "construction_cone": "Construction Cone", "construction_barrel": "Construction Barrel",
    "house_1": "House 1", "house_2": "House 2", "gas_station": "Gas Station",
    "fast_food": "Fast Food", "office_building": "Office Building", "lamp_post": "Lamp Post",
    "stop_sign": "Stop Sign", "speed_limit_sign": "Speed limit", "cordless_drill": "drill",
    "monkey_wrench": "monkey wrench", "robocup14_spl_field": "RoboCup 14 SPL Field",
    "robocup14_spl_goal": "RoboCup 2014 SPL Goal", "robocup_spl_ball": "RoboCup SPL Ball",
    "drc_practice_2x6": "lumber_2x6x48", "drc_practice_block_wall": "block_wall",
}
FOLDERS = (
    "cafe", "cafe_table", "grocery_store", "thrift_shop", "salon", "post_office", "law_office",
    "police_station", "fire_station", "school", "apartment", "radio_tower", "water_tower",
    "telephone_pole", "parking_garage", "postbox", "oak_tree", "pine_tree", "hatchback", "suv",
    "pickup", "bus_stop", "jersey_barrier", "fire_hydrant", "person_standing",
)


@pytest.mark.parametrize("folder, name", [*OWN.items(), *((name, name) for name in FOLDERS)])
def test_a_saved_state_finds_the_model(tmp_path, folder, name):
    file = tmp_path / "saved.world"
    file.write_text(f"""<sdf version="1.6"><world name="w">
        <include><uri>model://{folder}</uri></include>
        <state><model name="{name}"><pose>3 4 5 0 0 0</pose></model></state></world></sdf>""")
    assert load_world(file, RESOURCES).models[0].pose.position == (3, 4, 5)
