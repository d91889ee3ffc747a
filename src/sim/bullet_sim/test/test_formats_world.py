"""SDF worlds: defaults, includes, saved state, and the shape of the course world."""

import logging
import re

import pytest

from bullet_sim.description import PhysicsDescription, SceneDescription
from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import DATA_FOLDER, Resources

BOX = """<link name="link"><pose>0 0 0.5 0 0 0</pose><collision name="c"><geometry><box>
      <size>1 1 1</size>
</box></geometry></collision></link>"""


@pytest.fixture
def resources(tmp_path):
    return Resources([tmp_path / "models", DATA_FOLDER / "models"], [DATA_FOLDER])


@pytest.fixture
def load(tmp_path, resources):
    def read(body: str, version: str = "1.6"):
        file = tmp_path / "test.world"
        file.write_text(f'<sdf version="{version}"><world name="default">{body}</world></sdf>')
        return load_world(file, resources)
    return read


def put_model(tmp_path, folder: str, body: str, config: str | None = None) -> None:
    place = tmp_path / "models" / folder
    place.mkdir(parents=True)
    (place / "model.config").write_text(
        config or '<model><name>x</name><sdf version="1.4">model.sdf</sdf></model>')
    (place / "model.sdf").write_text(
        f'<sdf version="1.4"><model name="{place.name}">{body}</model></sdf>')


def test_an_empty_world_has_the_defaults_and_no_sun(load):
    world = load("")
    assert world.gravity == (0, 0, -9.8)
    assert (world.physics, world.scene) == (PhysicsDescription(), SceneDescription())
    assert world.models == world.lights == ()


SHIPPED_WORLDS = sorted((DATA_FOLDER / "worlds").glob("*"))


@pytest.mark.parametrize("file", SHIPPED_WORLDS, ids=lambda file: file.name)
def test_shipped_worlds_load_without_a_warning(file, resources, caplog):
    world = load_world(file, resources)
    assert (world.models and world.lights) or file.name == "blank.world"
    assert caplog.records == []


def test_empty_world_is_a_floor_and_a_sun(resources):
    world = load_world(resources.find_world("worlds/empty.world"), resources)
    floor, sun = world.models[0], world.lights[0]
    collision = floor.links[0].collisions[0]
    assert (floor.name, floor.static, collision.name) == ("ground_plane", True, "collision")
    assert (collision.surface.mu, collision.surface.mu2) == (100, 50)
    assert floor.links[0].visuals[0].material.diffuse == (0.7, 0.7, 0.7, 1)
    assert (sun.type, sun.direction, sun.cast_shadows) == ("directional", (-0.5, 0.5, -1), True)


def test_physics_and_scene(load):
    world = load("""<gravity>0 0 -1.6</gravity><physics type="ode">
    <max_step_size>0.002</max_step_size>
        <real_time_update_rate>0</real_time_update_rate><ode><solver><iters>150</iters>
        <sor>1.4</sor></solver>
        <constraints><cfm>0.00001</cfm>
        <contact_max_correcting_vel>2000.000000</contact_max_correcting_vel>
        </constraints></ode></physics>
        <scene><ambient>0 0 0 1</ambient><shadows>0</shadows><sky/></scene>""")
    assert world.gravity == (0, 0, -1.6)
    physics = world.physics
    assert (physics.max_step_size, physics.real_time_update_rate) == (0.002, 0)
    assert (physics.iterations, physics.sor, physics.cfm) == (150, 1.4, 1e-5)
    assert physics.contact_max_correcting_vel == 2000
    assert world.scene == SceneDescription(ambient=(0, 0, 0, 1), shadows=False, sky=True)


def test_gravity_of_old_worlds_stands_in_physics(load):
    assert load("<physics><gravity>0 0 -5</gravity></physics>", "1.4").gravity == (0, 0, -5)


def test_course_world_with_a_model_below_another_folder(tmp_path, load, caplog):
    uris = "model://turtlebot3_autorace/course/materials"
    put_model(tmp_path, "turtlebot3_autorace/course", f"""<static>1</static>
    <link name="course_link">
      <collision name="course_collision"><geometry><plane><normal>0 0 1</normal><size>4 4</size>
      </plane>
      </geometry></collision><visual name="course_visual"><cast_shadows>0</cast_shadows>
      <geometry><plane><normal>0 0 1</normal><size>4 4</size></plane></geometry>
      <material><script><uri>{uris}/scripts</uri><uri>{uris}/textures</uri><name>course</name>
      </script>
      </material></visual></link>""")
    materials = tmp_path / "models/turtlebot3_autorace/course/materials"
    (materials / "scripts").mkdir(parents=True)
    (materials / "textures").mkdir()
    (materials / "textures/course.png").write_bytes(b"")
    (materials / "scripts/course.material").write_text("""material course
        {
          technique
          {
            pass
            {
              texture_unit
              {
                texture course.png
              }
            }
          }
        }""")
    world = load("""<scene><ambient>0.4 0.4 0.4 1</ambient><background>0.7 0.7 0.7 1</background>
        <shadows>true</shadows></scene>
        <include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>
        <include><uri>model://turtlebot3_autorace/course</uri><pose>0 0 0 0 0 -1.54</pose></include>
        <physics type="ode"><real_time_update_rate>1000.0</real_time_update_rate></physics>""",
        "1.4")
    assert [model.name for model in world.models] == ["ground_plane", "course"]
    course = world.models[1]
    assert course.static and course.pose.rpy() == pytest.approx((0, 0, -1.54))
    visual = course.links[0].visuals[0]
    assert visual.material.texture == str(materials / "textures/course.png")
    assert visual.material.diffuse == (1, 1, 1, 1)
    assert caplog.records == []


def test_include_overrides(tmp_path, load):
    put_model(tmp_path, "crate", f"<pose>9 9 9 0 0 0</pose>{BOX}")
    world = load("""<include><uri>model://crate</uri></include>
        <include><uri>model://crate</uri><name>second</name><pose>1 2 3 0 0 0</pose>
        <static>true</static>
        <plugin name="p" filename="lib.so"/></include>""")
    first, second = world.models
    assert (first.name, first.pose.position, first.static) == ("crate", (9, 9, 9), False)
    assert (second.name, second.pose.position, second.static) == ("second", (1, 2, 3), True)
    assert second.plugins[0].filename == "lib.so"


def test_twins_get_names_of_their_own(tmp_path, load, caplog):
    put_model(tmp_path, "crate", BOX)
    world = load("<include><uri>model://crate</uri></include>" * 3)
    assert [model.name for model in world.models] == ["crate", "crate_0", "crate_1"]
    assert "already" in caplog.text


def test_model_config_chooses_the_newest_sdf_it_can_read(tmp_path, load):
    put_model(tmp_path, "crate", BOX, """<model><sdf version="1.9">new.sdf</sdf>
        <sdf version="1.6">model.sdf</sdf><sdf version="1.3">old.sdf</sdf></model>""")
    assert load("<include><uri>model://crate</uri></include>").models[0].name == "crate"


def test_missing_include_is_one_error_line_and_the_rest_loads(tmp_path, load, caplog):
    world = load("""<include><uri>model://gone</uri></include>
        <include><uri>model://sun</uri></include>""")
    assert [light.name for light in world.lights] == ["sun"]
    assert len(caplog.records) == 1
    assert caplog.records[0].levelno == logging.ERROR
    assert "model://gone not found" in caplog.text
    assert f"searched: {tmp_path / 'models'}, {DATA_FOLDER / 'models'}" in caplog.text


def test_model_that_includes_itself_is_an_error_line(tmp_path, load, caplog):
    put_model(tmp_path, "loop", BOX + "<include><uri>model://loop</uri></include>")
    assert load("<include><uri>model://loop</uri></include>").models[0].child_models == ()
    assert "includes itself" in caplog.text


def test_nested_include(tmp_path, load):
    put_model(tmp_path, "crate", BOX)
    put_model(tmp_path, "stack", f"""{BOX}<include><uri>model://crate</uri><name>upper</name>
        <pose>0 0 1 0 0 0</pose></include>""")
    model = load("<include><uri>model://stack</uri></include>").models[0]
    assert [link.name for link in model.links] == ["link", "upper::link"]
    assert model.links[1].pose.position == (0, 0, 1.5)


def test_state_overrides_poses(load):
    world = load(f"""<model name="box">{BOX}</model><model name="gone">{BOX}</model>
        <light name="lamp" type="point"><pose>0 0 1 0 0 0</pose></light>
        <state world_name="default"><sim_time>1 2</sim_time>
          <model name="box"><pose frame="">1 2 0 0 -0 0</pose>
            <link name="link"><pose>1 2 0.75 0 0 0</pose></link></model>
          <model name="never_was"><pose>0 0 0 0 0 0</pose></model>
          <light name="lamp"><pose>5 6 7 0 0 0</pose></light>
          <insertions><model name="late">{BOX}</model></insertions>
          <deletions><name>gone</name></deletions></state>""")
    assert [model.name for model in world.models] == ["box", "late"]
    box = world.models[0]
    assert box.pose.position == (1, 2, 0)
    assert box.links[0].pose.position == pytest.approx((0, 0, 0.75))  # saved in the world frame
    assert world.lights[0].pose.position == (5, 6, 7)


def test_a_pose_of_the_oldest_files_is_known_and_a_urdf_origin_is_not(load, caplog):
    # conforms: SDF 1.2 to 1.7/origin pose
    model = load(f'''<model name="m"><origin pose="1 2 3 0 0 0"/>{BOX}</model>''').models[0]
    assert model.pose.position == (1, 2, 3)
    assert caplog.records == []
    load(f'''<model name="m"><origin xyz="1 2 3"/>{BOX}</model>''')
    assert "model 'm': <origin> is not known, left out" in caplog.text


def test_unknown_elements_are_one_warning_each(load, caplog, tmp_path):
    # conforms: SDF 1.2 to 1.7/unknown element, SDF 1.2 to 1.7/foreign namespace
    load(f"""<gui/><wind/><atmosphere/><my:own/><elevator/><elevator/>
        <model name="m">{BOX.replace("collision", "colision")}</model>""")
    file = tmp_path / "test.world"
    assert [record.getMessage() for record in caplog.records] == [
        f"{file}: world 'default': <elevator> is not known, left out",
        f"{file}: world 'default', model 'm', link 'link': <colision> is not known, "
        "left out (did you mean <collision>?)"]


def test_world_plugins_are_kept(load):
    assert load('<plugin name="p" filename="libx.so"/>').plugins[0].filename == "libx.so"


def test_missing_world_file_names_the_folders(resources, tmp_path):
    with pytest.raises(ResourceNotFound, match=f"worlds/gone.world not found.*{DATA_FOLDER}"):
        resources.find_world("worlds/gone.world")
    with pytest.raises(ResourceNotFound, match=r"no\.world not found"):
        load_world(tmp_path / "no.world", resources)


def test_error_in_a_world_names_the_file(load, caplog):
    load("""<model name="m"><link name="l"><collision name="c"><geometry><box><size>1 2</size></box>
            </geometry></collision></link></model>""")
    assert re.search(r"/test\.world: model 'm', link 'l'.* '1 2' is not 3 numbers", caplog.text)


def test_world_in_another_encoding_is_read(tmp_path, resources):
    file = tmp_path / "gbk.world"
    file.write_bytes('<sdf version="1.6"><!-- 赛道 --><world name="w"/></sdf>'.encode("gbk"))
    assert load_world(file, resources).name == "w"


def test_a_missing_world_of_a_folder_is_looked_for_among_its_neighbours(resources, tmp_path):
    (tmp_path / "moving.world").touch()
    with pytest.raises(ResourceNotFound, match=r"did you mean moving\.world") as caught:
        resources.find_world(str(tmp_path / "movng.world"))
    assert "empty.world" not in str(caught.value)
    (tmp_path / "lane.world").touch()
    with pytest.raises(ResourceNotFound) as caught:
        resources.find_world(str(tmp_path / "nope.world"))
    assert "did you mean" not in str(caught.value)
