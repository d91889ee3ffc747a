"""What worlds contain besides models: actors, populations, roads, saved states, frames."""

import math
from unittest.mock import Mock

import numpy as np
import pytest

from bullet_sim.actors import pose_at
from bullet_sim.description import Box, Strip, Trajectory
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.ogre import named_materials
from bullet_sim.formats.resources import DATA_FOLDER, Resources
from bullet_sim.pose import Pose
from bullet_sim.world import World

BOX = """<link name="link"><visual name="v"><geometry><box><size>1 1 1</size></box></geometry>
    </visual><collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
    </link>"""
BOX_MODEL = f"<model name='box'>{BOX}</model>"
WALK = """<trajectory id="1" type="walk"><waypoint><time>2</time><pose>4 2 0 0 0 0</pose></waypoint>
    </trajectory>
    <trajectory id="0" type="walk"><waypoint><time>4</time><pose>4 0 0 0 0 1.5</pose></waypoint>
    <waypoint><time>0</time><pose>0 0 0 0 0 0</pose></waypoint></trajectory>"""


@pytest.fixture
def load(tmp_path):
    def read(body: str, version: str = "1.6"):
        file = tmp_path / "test.world"
        file.write_text(f'<sdf version="{version}"><world name="w">{body}</world></sdf>')
        return load_world(file, Resources([tmp_path / "models", DATA_FOLDER / "models"],
                                          [DATA_FOLDER]))
    return read


# --- actors

def test_actor_walks_its_trajectories_one_after_the_other(load):
    # conforms: sdf world/actor, sdf actor/script/trajectory, sdf actor/skin
    # conforms: sdf trajectory/waypoint/time, sdf trajectory/waypoint/pose
    description = load(f"""<actor name="bob"><pose>9 9 9 0 0 0</pose>
        <skin><filename>walk.dae</filename><scale>2</scale></skin>
        <script>{WALK}</script></actor>""")
    actor = description.models[0]
    assert [time for time, _ in actor.trajectory.waypoints] == [0, 4, 6]
    assert actor.links[0].collisions == ()
    body, head = actor.links[0].visuals
    assert body.geometry.length == pytest.approx(2.9)  # scaled
    assert body.pose.position == pytest.approx((0.0, 0.0, 1.45))  # its feet on the ground
    assert head.pose.position == pytest.approx((0.0, 0.0, 2.9 + head.geometry.radius))
    assert body.cast_shadows and load(BOX_MODEL).models[0].links[0].visuals[0].cast_shadows
    world = World(description)
    bob = world.model("bob")
    world.step(1000)
    assert bob.pose.position == pytest.approx((1, 0, 0), abs=0.05)
    assert bob.pose.rpy()[2] == pytest.approx(1.5 / 4, abs=0.02)
    seen = world.update_scene().nodes["bob", "bob_pose"].pose.position
    assert seen == pytest.approx(bob.pose.position)
    world.step(4000)
    assert bob.pose.position == pytest.approx((4, 1, 0), abs=0.05)
    world.step(2000)
    assert bob.pose.position == pytest.approx((1, 0, 0), abs=0.05)  # round again
    world.reset_simulation()
    world.step(500)
    assert bob.pose.position == pytest.approx((0.5, 0, 0), abs=0.05)
    world.delete("bob")
    world.step(10)
    world.close()


def test_actor_waits_loops_and_can_stand_still(load):
    # conforms: sdf actor/script/loop, sdf actor/script/delay_start, sdf actor/script/auto_start
    # conforms: sdf actor/pose
    actors = load(f"""
        <actor name="once"><script><loop>false</loop><delay_start>1</delay_start>{WALK}</script>
        </actor>
        <actor name="again"><script><delay_start>1</delay_start>{WALK}</script></actor>
        <actor name="never"><script><auto_start>0</auto_start>{WALK}</script></actor>
        <actor name="statue"><pose>1 2 3 0 0 0</pose></actor>""").models
    once, again, never = (actor.trajectory for actor in actors[:3])
    assert [pose_at(once, t).position[0] for t in (0.5, 1, 3, 99)] == [0, 0, 2, 4]
    assert pose_at(again, 7.5).position == (0, 0, 0)  # each round begins with the delay
    assert pose_at(again, 10).position[0] == pytest.approx(2)
    assert pose_at(never, 3).position == (0, 0, 0)
    assert actors[3].pose.position == (1, 2, 3) and actors[3].trajectory is None


def test_an_actor_turns_the_short_way():
    turn = Trajectory(((0, Pose.from_xyz_rpy((0, 0, 0), (0, 0, 3))),
                       (1, Pose.from_xyz_rpy((0, 0, 0), (0, 0, -3)))))
    assert abs(pose_at(turn, 0.5).rpy()[2]) == pytest.approx(math.pi)


def test_links_of_an_actor_go_with_it_and_are_seen_by_lasers(load):
    # conforms: sdf actor/link, sdf actor/plugin
    description = load(f"""<actor name="a"><script>{WALK}</script>{BOX}
        <plugin name="p" filename="libx.so"/></actor>""")
    assert description.models[0].plugins[0].filename == "libx.so"
    world = World(description)
    world.step(2000)
    above = np.array([[2.0, 0, 5], [0.0, 0, 5]])
    hits = world.cast_rays(above, above * (1, 1, 0))
    assert hits.fraction == pytest.approx([0.9, 1.0], abs=0.02)
    world.close()


def test_a_bad_actor_is_one_error_line_and_the_world_loads(load, caplog):
    world = load(f"""<actor name="a"><script><trajectory id="0"><waypoint><time>x</time></waypoint>
        </trajectory></script></actor><model name="m">{BOX}</model>""")
    assert [model.name for model in world.models] == ["a", "m"]
    assert "<script> <waypoint> <time>: 'x' is not a number; 0 is used instead" in caplog.text


# --- populations

def population(rest: str) -> str:
    return (f'<population name="crowd"><model name="can"><pose>0 0 0.5 0 0 0</pose>{BOX}</model>'
            f"<pose>10 0 0 0 0 0</pose>{rest}</population>")


def places(world) -> np.ndarray:
    return np.array([model.pose.position for model in world.models])


@pytest.mark.parametrize("kind", ["random", "uniform"])
def test_population_in_a_box(load, kind):
    # conforms: sdf world/population, sdf population/model, sdf population/model_count
    # conforms: sdf population/pose, sdf population/box, sdf population/distribution/type
    text = population(f"""<box><size>4 2 0.02</size></box><model_count>12</model_count>
        <distribution><type>{kind}</type></distribution>""")
    world = load(text)
    assert [model.name for model in world.models][:2] == ["can_clone_0", "can_clone_1"]
    found = places(world) - (10, 0, 0.5)
    assert found.shape == (12, 3)
    assert (np.abs(found) <= (2, 1, 0.01)).all() and np.ptp(found[:, 0]) > 2
    assert (places(load(text)) == places(world)).all()  # the same in each run
    gaps = np.linalg.norm(found[:, None] - found, axis=2) + np.eye(12) * 9
    assert (gaps.min() > 0.5) == (kind == "uniform")


def test_population_in_a_cube_of_a_metre_unless_told(load):
    found = places(load(population("<model_count>99</model_count>"))) - (10, 0, 0.5)
    assert (np.abs(found) <= 0.5).all() and (np.ptp(found, axis=0) > 0.9).all()


def test_population_in_a_cylinder(load):
    # conforms: sdf population/cylinder
    found = places(load(population("""<cylinder><radius>3</radius><length>0.1</length></cylinder>
        <model_count>30</model_count>"""))) - (10, 0, 0.5)
    reach = np.hypot(found[:, 0], found[:, 1])
    assert reach.max() <= 3 and reach.max() > 2


def test_population_on_a_grid_and_in_a_row(load):
    # conforms: sdf population/distribution/rows, sdf population/distribution/cols
    # conforms: sdf population/distribution/step
    grid = places(load(population("""<distribution><type>grid</type><rows>2</rows><cols>3</cols>
        <step>1 2 0</step></distribution>""")))
    assert sorted(set(grid[:, 0])) == [9.5, 10.5] and sorted(set(grid[:, 1])) == [-2, 0, 2]
    one = places(load(population("<distribution><type>grid</type></distribution>")))
    assert one.tolist() == [[10, 0, 0.5]]
    line = places(load(population("""<distribution><type>grid</type><rows>2</rows>
        <step>1 2 0</step></distribution>""")))
    assert line.tolist() == [[9.5, 0, 0.5], [10.5, 0, 0.5]]
    usual = places(load(population("""<distribution><type>grid</type><rows>2</rows><cols>2</cols>
        </distribution>""")))
    assert usual.tolist() == [[9.75, -0.25, 0.5], [9.75, 0.25, 0.5], [10.25, -0.25, 0.5],
                              [10.25, 0.25, 0.5]]
    row = places(load(population("""<box><size>4 4 4</size></box><model_count>3</model_count>
        <distribution><type>linear-y</type></distribution>""")))
    assert row.tolist() == [[10, -2, 0.5], [10, 0, 0.5], [10, 2, 0.5]]


def test_a_population_without_bounds_is_refused(load, caplog):
    assert load(population("<model_count>1000000000</model_count>")).models == ()
    assert "1000000000 models are not possible; 0 to 1000 are; left out" in caplog.text


def test_a_thousand_places_and_no_more_populations_after_them(load, caplog, monkeypatch):
    crowd = population("""<box><size>99 99 1</size></box><model_count>1000</model_count>
        <distribution><type>uniform</type></distribution>""")
    norm = Mock(wraps=np.linalg.norm)
    monkeypatch.setattr(np.linalg, "norm", norm)
    assert len(load(crowd * 5).models) == 1000
    assert norm.call_count <= 1000  # 20 for each pair of places took a minute
    assert "<population>s of over 1000 models; the rest is left out" in caplog.text


# --- roads

def test_road_is_drawn_and_not_touched(load):
    # conforms: sdf world/road, sdf road/width, sdf road/point, sdf road/material
    description = load("""<road name="street"><width>3</width><point>0 0 0</point>
        <point>10 0 0</point><material><script><name>Gazebo/Red</name></script></material></road>
        <road name="path"><point>0 5 0</point><point>9 5 0</point></road>""")
    (_, street), (_, path) = description.scenery
    assert street.geometry == Strip(((0, 0, 0), (10, 0, 0)), 3)
    assert street.pose.position[:2] == (0.0, 0.0)
    assert 0.0 < street.pose.position[2] < 0.02  # above the ground, and not to be seen
    assert street.material == named_materials()["Gazebo/Red"]
    assert path.material == named_materials()["Gazebo/Road"] and path.geometry.width == 1
    world = World(description)
    assert world.models == {} and len(world.scene.nodes) == 2
    hit = world.cast_rays(np.array([[5.0, 0, 1]]), np.array([[5.0, 0, -1]]))
    assert hit.fraction[0] == 1
    world.close()


# --- saved states

def test_state_of_a_saved_world(load):
    # conforms: sdf world/state, sdf state/sim_time, sdf state/model/pose, sdf state/model/scale
    # conforms: sdf state/model/link, sdf state/light, sdf state/insertions, sdf state/deletions
    description = load(f"""<model name="box"><static>1</static>{BOX}
          <model name="lid"><pose>0 0 1 0 0 0</pose>{BOX}</model></model>
        <model name="gone">{BOX}</model><light name="lamp" type="point"/>
        <state world_name="w"><sim_time>7 250000000</sim_time><real_time>9 0</real_time>
          <wall_time>1 0</wall_time><iterations>7250</iterations>
          <model name="box"><pose frame="">1 2 0 0 -0 0</pose><scale>2 1 1</scale>
            <link name="link"><pose>1 2 0.5 0 0 0</pose><velocity>0 0 0 0 0 0</velocity></link>
            <model name="lid"><link name="link"><pose>1 2 3 0 0 0</pose></link></model></model>
          <model name="ground"><pose>0 0 0 0 0 0</pose></model>
          <light name="lamp"><pose>5 6 7 0 0 0</pose></light>
          <insertions><model name="late">{BOX}</model><model name="box">{BOX}</model>
            <light name="torch" type="spot"/></insertions>
          <deletions><name>gone</name></deletions></state>""")
    assert [model.name for model in description.models] == ["box", "late"]
    box = description.models[0]
    assert box.pose.position == (1, 2, 0)
    assert [link.pose.position for link in box.links] == [(0, 0, 0.5), (0, 0, 3)]
    assert box.links[0].collisions[0].geometry == Box((2, 1, 1))
    assert box.links[1].visuals[0].geometry == Box((2, 1, 1))
    assert [light.name for light in description.lights] == ["lamp", "torch"]
    assert description.lights[0].pose.position == (5, 6, 7)
    world = World(description)
    assert world.time == 7.25
    world.step()
    world.reset_simulation()
    assert world.time == 0
    world.close()


def test_what_is_wrong_in_a_state_is_an_error_line_and_does_not_count(load, caplog):
    world = load(f'''<model name="m"><pose>7 0 0 0 0 0</pose>{BOX}</model>
        <state><sim_time>x</sim_time><model name="m"><pose>1 2 3</pose><scale>1 0 1</scale></model>
        </state>''')
    assert world.models[0].pose.position == (7, 0, 0)
    assert world.sim_time == 0
    for said in ("<state> of model 'm' <scale>: 0 leaves nothing; 1 1 1 is used instead",
                 "<pose>: '1 2 3' is not 6 numbers; 7 0 0 0 0 0 is used instead",
                 "<sim_time>: 'x' is not a number; 0 is used instead"):
        assert said in caplog.text


# --- frames

def test_world_frames_and_models_relative_to_each_other(load):
    # conforms: sdf world/frame, sdf pose@relative_to, sdf frame@attached_to, sdf frame/pose
    world = load(f"""<frame name="corner"><pose>1 0 0 0 0 1.5707963267948966</pose></frame>
        <frame name="above" attached_to="corner"><pose>0 0 2 0 0 0</pose></frame>
        <model name="a"><pose relative_to="above">1 0 0 0 0 0</pose>{BOX}</model>
        <model name="b"><pose relative_to="a">1 0 0 0 0 0</pose>{BOX}</model>
        <light name="l" type="point"><pose relative_to="corner">0 0 5 0 0 0</pose></light>
        """, "1.7")
    assert world.models[0].pose.position == pytest.approx((1, 1, 2))
    assert world.models[1].pose.position == pytest.approx((1, 2, 2))
    assert world.lights[0].pose.position == pytest.approx((1, 0, 5))


def test_parts_of_a_link_relative_to_other_frames(load, caplog):
    # conforms: sdf pose@frame, sdf model/frame, sdf link/visual, sdf link/collision
    link = load("""<model name="m"><frame name="f"><pose>0 0 3 0 0 0</pose></frame>
        <link name="a"><pose>1 0 0 0 0 0</pose>
          <visual name="v"><pose relative_to="f">0 0 1 0 0 0</pose>
            <geometry><sphere/></geometry></visual>
          <visual name="w"><pose frame="">0 0 1 0 0 0</pose><geometry><sphere/></geometry></visual>
          <collision name="c"><pose frame="b">0 0 1 0 0 0</pose><geometry><sphere/></geometry>
          </collision>
          <visual name="u"><pose relative_to="gone">0 0 1 0 0 0</pose>
            <geometry><sphere/></geometry></visual></link>
        <link name="b"><pose>0 5 0 0 0 0</pose></link></model>""", "1.7").models[0].links[0]
    assert [v.pose.position for v in link.visuals] == [(-1, 0, 4), (0, 0, 1), (0, 0, 1)]
    assert link.collisions[0].pose.position == (-1, 5, 1)
    assert "relative to 'gone', which is not in the model; the link frame is taken" in caplog.text


def test_twin_lights_get_names_of_their_own(load, caplog):
    # conforms: sdf world/light
    world = load('<include><uri>model://sun</uri></include>' * 2 + '<light name="sun"/>')
    assert [light.name for light in world.lights] == ["sun", "sun_0", "sun_1"]
    assert "a light named 'sun' is there already" in caplog.text
    World(world).close()


# --- physics

def test_the_default_profile_counts_and_old_names_are_known(load):
    # conforms: sdf world/physics, sdf physics@default, sdf physics/max_step_size
    # conforms: sdf physics/real_time_update_rate, sdf physics/gravity, sdf physics/update_rate
    # conforms: sdf physics/ode/solver/dt, sdf physics/magnetic_field
    world = load("""<physics name="a"><max_step_size>0.01</max_step_size></physics>
        <physics name="b" default="1"><max_step_size>0.002</max_step_size>
        <real_time_update_rate>500</real_time_update_rate></physics>""")
    assert (world.physics.max_step_size, world.physics.real_time_update_rate) == (0.002, 500)
    old = load("""<physics type="ode"><update_rate>250</update_rate><gravity>0 0 -3</gravity>
        <magnetic_field>1 2 3</magnetic_field>
        <ode><solver><dt>0.004</dt></solver></ode></physics>""", "1.2")
    assert (old.physics.max_step_size, old.physics.real_time_update_rate) == (0.004, 250)
    assert (old.gravity, old.magnetic_field) == ((0, 0, -3), (1, 2, 3))


@pytest.mark.parametrize("written, residual", [("<residual>1e-6</residual>", 1e-6), ("", None)])
def test_a_world_may_say_how_exactly_it_is_solved(load, written, residual):
    world = load(f"<physics><bullet><solver>{written}</solver></bullet></physics>")
    assert world.physics.residual == residual


def test_solver_numbers_are_kept(load):
    # conforms: sdf physics/ode/solver/iters, sdf physics/ode/solver/sor, sdf physics/max_contacts
    # conforms: sdf physics/ode/solver/precon_iters, sdf physics/ode/constraints/cfm
    # conforms: sdf physics/ode/constraints/erp, sdf physics/real_time_factor
    # conforms: sdf physics/ode/constraints/contact_max_correcting_vel
    # conforms: sdf physics/ode/constraints/contact_surface_layer
    physics = load("""<physics type="ode"><max_contacts>7</max_contacts>
        <real_time_factor>0.5</real_time_factor><ode><solver><iters>77</iters>
        <precon_iters>3</precon_iters><sor>1.1</sor></solver><constraints><cfm>0.1</cfm><erp>0.3</erp>
        <contact_max_correcting_vel>4</contact_max_correcting_vel>
        <contact_surface_layer>0.01</contact_surface_layer></constraints></ode></physics>""").physics
    assert (physics.max_contacts, physics.iterations, physics.precon_iterations) == (7, 77, 3)
    assert (physics.sor, physics.cfm, physics.erp) == (1.1, 0.1, 0.3)
    assert (physics.contact_max_correcting_vel, physics.contact_surface_layer) == (4, 0.01)
    assert physics.real_time_factor == 0.5


@pytest.mark.parametrize("text, seconds", [("7", 7.0), ("7 500000000", 7.5), ("", 0.0)])
def test_the_time_of_a_saved_state_is_in_seconds_and_nanoseconds(load, text, seconds):
    assert load(f"<state><sim_time>{text}</sim_time></state>").sim_time == seconds
