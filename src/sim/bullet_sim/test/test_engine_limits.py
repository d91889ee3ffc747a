"""What the engine cannot hold, refuses or loses: said in one line, and all else goes on."""

import itertools
import logging
import math
import os
from dataclasses import replace

import numpy as np
import pytest

from bullet_sim.description import (
    Inertial,
    LinkDescription,
    ModelDescription,
    PhysicsDescription,
    WorldDescription,
)
from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.physics.client import FREE_GROUPS
from bullet_sim.physics.collision_filters import CollisionFilters
from bullet_sim.physics.engine import STDERR, STDOUT, EngineError, pybullet, quiet
from bullet_sim.physics.parameter_bounds import KEPT, MOST_POSITIONS
from bullet_sim.pose import IDENTITY, Pose, quaternion_from_rpy, rotation_matrix
from bullet_sim.world import World

BOX = "<collision name='c'><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision>"
PLANE = """<model name="m"><static>true</static><link name="l"><collision name="c"><geometry>
  <plane><normal>0 0 1</normal></plane></geometry></collision></link></model>"""


def read(body: str):
    return load_model(f'<sdf version="1.6">{body}</sdf>', Resources())


def star(*kinds: str):
    """Links around one, each on a joint of that kind."""
    arms = "".join(f'<link name="l{n}"/><joint name="j{n}" type="{kind}"><parent>hub</parent>'
                   f"<child>l{n}</child></joint>" for n, kind in enumerate(kinds))
    return read(f'<model name="m"><link name="hub"/>{arms}</model>')


def engine_bodies(world: World) -> int:
    return world._client.read(pybullet.getNumBodies)


def assert_empty(world: World) -> None:
    """Nothing is left of what was to be there."""
    assert not world.models and not world._client.auto_disable.bodies and not world.scene.lights
    assert not world._client.planes._places
    assert engine_bodies(world) == 0
    world.step(100)


def test_as_many_joints_as_the_engine_can_tell_of(world):
    for kinds in (["revolute"] * MOST_POSITIONS, ["ball"] * 30 + ["revolute"]):
        model = world.spawn(star(*kinds), name=f"of {len(kinds)}")
        last = model.joint(f"j{len(kinds) - 1}")
        last.reset(0.25, 1.5)
        assert (last.position, last.velocity) == (0.25, 1.5)


@pytest.mark.parametrize("kinds, said", [
    (["revolute"] * 122, "m has 122 moving joints in one piece; the engine takes at most 121"),
    (["ball"] * 31, r"has 31 moving joints .*\(31 balls among them, which count 4 times\)"),
    (["universal"] * 61, "has 122 moving joints"),
    (["fixed"] * 128, "model m has 129 links in one piece, .* the engine takes at most 128"),
])
def test_more_joints_are_refused_before_anything_is_built(world, kinds, said):
    with pytest.raises(SimulationError, match=said):
        world.spawn(star(*kinds))
    assert_empty(world)


def test_a_static_model_may_have_any_number_of_links(world):
    body = "".join(f'<link name="l{n}"><pose>{n} 0 0 0 0 0</pose>{BOX}</link>' for n in range(300))
    model = world.spawn(read(f'<model name="m"><static>true</static>{body}</model>'),
                        Pose((0, 0, 2)))
    assert model.links["l299"].pose.position == pytest.approx((299, 0, 2))
    below = np.array([(n, 0.0, 0.0) for n in range(300)])
    assert all(world.cast_rays(below + np.array((0.0, 0.0, 9.0)), below).fraction < 1.0)
    model.move_link(model.links["l299"], Pose((299, 5, 2)), model.links["l299"].twist)
    assert model.links["l0"].pose.position == pytest.approx((0, 5, 2))
    world.delete("m")
    assert_empty(world)


@pytest.mark.parametrize("fails", ["attach", "_needs_filter", "Body", "show"])
def test_what_a_failed_spawn_made_is_removed(world, monkeypatch, fails):
    def refuse(*_args, **_keywords):
        raise EngineError("no")

    if fails == "Body":  # in the middle of a body
        monkeypatch.setattr("bullet_sim.physics.body_joints.BodyJoints.set_up", refuse)
    elif fails == "show":
        monkeypatch.setattr(world, "_show", refuse)
    else:
        monkeypatch.setattr(CollisionFilters, fails, refuse)
    for text in (PLANE, f'<model name="m"><link name="a">{BOX}</link><link name="b">{BOX}</link>'
                 "</model>"):
        if fails == "_needs_filter" and text is PLANE:
            continue  # there is nothing to tell
        with pytest.raises(EngineError):
            world.spawn(read(text))
        assert_empty(world)


def test_pairs_that_a_failed_spawn_gave_the_engine_are_removed(world, monkeypatch):
    told, tell = [], world._client.change

    def refuse_the_second(function, *args, **keywords):
        if function is pybullet.setCollisionFilterPair:
            if len(told) == 1 and not args[4]:
                raise EngineError("no")
            told.append((args[:4], args[4]))
        return tell(function, *args, **keywords)

    monkeypatch.setattr(world._client, "change", refuse_the_second)
    links = "".join(f'<link name="{name}">{BOX}</link>' for name in "abc")
    with pytest.raises(EngineError):
        world.spawn(read(f'<model name="m">{links}</model>'))
    assert told == [(told[0][0], 0), (told[0][0], 1)]
    assert_empty(world)


def loose(count: int, around: str = ""):
    """A model of links in one place that no joint connects."""
    links = "".join(f'<link name="l{number}">{BOX}</link>' for number in range(count))
    return read(f'<model name="m">{around}{links}</model>')


def test_many_links_without_joints_are_filtered_as_a_group(world, monkeypatch):
    change, pairs = world._client.change, []
    monkeypatch.setattr(world._client, "change", lambda function, *args, **keywords: (
        pairs.append(1) if function is pybullet.setCollisionFilterPair
        else change(function, *args, **keywords)))
    world.spawn(read(PLANE), name="ground")
    for number in range(len(FREE_GROUPS)):
        world.spawn(loose(80), Pose((number, 0.0, 0.0)), name=f"m{number}")
    world.step()
    touching = {name.split("::")[0] for contact in world.contacts() for name in contact.links}
    assert touching == {"ground", *(f"m{number}" for number in range(len(FREE_GROUPS)))}
    assert all("ground::l" in contact.links for contact in world.contacts())
    with pytest.raises(SimulationError, match="model m has 80 links that collide with others but "
                                              "not with one another, which takes long; make"):
        world.spawn(loose(80))
    world.delete("m0")
    world.spawn(loose(80))
    assert not pairs


def test_links_of_one_static_model_do_not_touch_one_another(world):
    world.spawn(loose(200, "<static>1</static>"))
    world.step()
    assert not world.contacts()
    world.spawn(loose(1), name="on_it")
    world.step()
    assert all("on_it::l0" in contact.links for contact in world.contacts())
    assert world.contacts()


def test_a_crowd_is_left_out_of_a_world_with_one_line(caplog):
    models = [replace(loose(1), name=f"m{number}", pose=Pose((0.01 * (number % 2), 0.0, 1.0)))
              for number in range(60)]
    world = World(WorldDescription(name="w", models=tuple(models)))
    assert len(world.models) == 50
    assert [line.getMessage() for line in caplog.records] == [
        "world w, model 'm50': too many shapes lie in one another at 0 0 1, so that a step would "
        "take minutes; give each a <pose> of its own; it and 9 models after it are left out"]
    for name in list(world.models):
        world.delete(name)
    assert world._client.crowding._overlaps == 0
    for model in models:
        world.spawn(replace(model, pose=IDENTITY), Pose((0.1 * int(model.name[1:]), 0.0, 1.0)))
    assert len(world.models) == 60
    world.close()


def test_what_is_gone_does_not_crowd(world):
    hand = "".join(f'<link name="{n}">{BOX}</link>' for n in range(10))
    world.spawn(read(f'<model name="hand">{hand}</model>'))
    for _ in range(250):  # each lies in all ten
        world.spawn(read(f'<model name="held"><link name="a">{BOX}</link></model>'))
        world.delete("held")
    assert world._client.crowding._overlaps == 0


def test_flat_plates_turn_however_they_lie():
    """Of moments just beyond the triangle rule the engine takes none; rounding makes such ones."""
    random, world = np.random.default_rng(0), World(WorldDescription(gravity=(0.0, 0.0, 0.0)))
    links = {}
    for number in range(30):
        x, y = random.uniform(0.05, 1.0, 2)  # m, its sides
        turn = rotation_matrix(quaternion_from_rpy(*random.uniform(-2.0, 2.0, 3)))
        tensor = turn @ np.diag([y * y, x * x, x * x + y * y]) @ turn.T / 12.0
        inertial = Inertial(1.0, inertia=tuple(tensor[np.triu_indices(3)].tolist()))
        link = world.spawn(ModelDescription(
            f"{number}", links=(LinkDescription("l", inertial=inertial),))).links["l"]
        links[link] = turn[:, 2]
        link.apply_force((0.0, 0.0, 0.0), tuple((x * x + y * y) / 12.0 * turn[:, 2]))
    world.step()
    for link, normal in links.items():
        assert link.twist.angular == pytest.approx(world.timestep * normal, abs=1e-6)
    world.close()


def test_what_the_engine_prints_is_not_seen_and_what_follows_is(capfd):
    with quiet(STDOUT, STDERR):
        for stream in (1, 2):
            os.write(stream, b"b3Printf\n")
    for stream in (1, 2):
        os.write(stream, b"after\n")
    assert capfd.readouterr() == ("after\n", "after\n")


def test_a_text_that_the_engine_refuses_is_our_own_error(world, monkeypatch):
    monkeypatch.setattr("bullet_sim.physics.client.urdf_text", lambda *_: "nonsense")
    with pytest.raises(SimulationError, match="the engine rejects link a and the links below it"):
        world.spawn(read('<model name="m"><link name="a"/></model>'))
    assert_empty(world)


def test_a_body_that_the_engine_has_lost_takes_its_model_with_it(world, caplog):
    gone = []
    world.each_removal.append(gone.append)
    lost = world.spawn(read(f'<model name="m"><link name="a">{BOX}</link></model>'))
    falls = world.spawn(read(f'<model name="other"><link name="a">{BOX}</link></model>'))
    world._client.read(pybullet.removeBody, lost.bodies[0].number)
    world.step(200)
    assert world.tick == 200
    assert gone == ["m"] and list(world.models) == ["other"]
    assert falls.pose.position[2] < -0.15
    said = [record for record in caplog.records if record.levelno >= logging.ERROR]
    assert len(said) == 1 and "model m is deleted" in said[0].message


def test_an_error_that_no_model_causes_is_said_once(world, caplog):
    def refuse():
        raise EngineError("not today")

    world.each_step.append(refuse)
    world.step(50)
    assert world.tick == 50
    assert [record.message for record in caplog.records] == [
        "an engine step failed: not today; the world goes on"]


def test_numbers_that_are_only_kept_have_to_be_numbers(world):
    for field, value in itertools.product(KEPT, (math.nan, math.inf, -1.0)):
        with pytest.raises(SimulationError, match=f"{KEPT[field]} is .*finite and not below 0"):
            world.configure_physics(**{field: value})
        assert world.description.physics == PhysicsDescription()
