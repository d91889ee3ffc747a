"""Saved worlds name what was included by the models' own names, which are not always the folders'.

Facts of the public model files of that address, newest version.
"""

import pytest

from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import DATA_FOLDER, Resources

RESOURCES = Resources([DATA_FOLDER / "models"], [DATA_FOLDER])
OWN = {
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
