"""True maps of worlds whose walls are known."""

import numpy as np
import pytest

from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN
from trial_worlds.house import open_walls, true_map, visible_walls

BOX = """<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l">
<collision name="c"><geometry><box><size>{size}</size></box></geometry></collision></link>
</model>"""
CYLINDER = """<model name="post"><static>true</static><pose>0.5 0.5 0.5 0 0 0</pose><link name="l">
<collision name="c"><geometry><cylinder><radius>0.2</radius><length>1</length></cylinder></geometry>
</collision></link></model>"""
WALLS = {"north": ("0 1.05 0.5 0 0 0", "2.2 0.1 1"), "south": ("0 -1.05 0.5 0 0 0", "2.2 0.1 1"),
         "east": ("1.05 0 0.5 0 0 0", "0.1 2.2 1"), "west": ("-1.05 0 0.5 0 0 0", "0.1 2.2 1")}
ACTOR = """<actor name="walker"><pose>-0.5 0.5 0 0 0 0</pose><link name="l"><collision name="c">
<pose>0 0 0.5 0 0 0</pose><geometry><box><size>0.3 0.3 1</size></box></geometry></collision></link>
<script><trajectory id="0" type="walk"><waypoint><time>0</time><pose>-0.5 0.5 0 0 0 0</pose>
</waypoint><waypoint><time>9</time><pose>0.5 0.5 0 0 0 0</pose></waypoint></trajectory></script>
</actor>"""


@pytest.fixture
def room(tmp_path):
    """Opens a world of 2 m by 2 m inside its walls, with more things in it."""
    worlds = []

    def build(*things, walls=WALLS):
        path = tmp_path / "room.world"
        boxes = [BOX.format(name=name, pose=pose, size=size)
                 for name, (pose, size) in walls.items()]
        path.write_text(f"<sdf version='1.6'><world name='w'>{''.join([*boxes, *things])}"
                        f"</world></sdf>")
        worlds.append(open_walls(path))
        return worlds[-1]

    yield build
    for world in worlds:
        world.close()


def test_a_room_is_free_within_and_its_inner_faces_are_walls(room):
    grid = true_map(room(), 0.3, [(0.0, 0.0)], resolution=0.1, reach=3.0)
    assert grid.cells.shape == (24, 24)
    assert grid.origin == pytest.approx((-1.2, -1.2))
    expected = np.full((24, 24), UNKNOWN)
    expected[1:23, 1:23], expected[2:22, 2:22] = OCCUPIED, FREE
    assert np.array_equal(grid.cells, expected)


def test_what_is_lower_or_higher_than_the_laser_is_no_wall(room):
    box = BOX.format(name="step", pose="0.5 0 0.1 0 0 0", size="0.2 0.2 0.2")
    low, high = (true_map(room(box), height, [(0.0, 0.0)], 0.1, 3.0) for height in (0.1, 0.3))
    here = tuple(low.cells_of([0.45, 0.05]))
    assert (low.cells[here], high.cells[here]) == (OCCUPIED, FREE)
    with pytest.raises(ValueError, match=r"no surface at 1\.5 m"):
        true_map(room(), 1.5, [(0.0, 0.0)], 0.1, 3.0)


def test_walls_are_found_behind_a_ball(room):
    ball = CYLINDER.replace("cylinder", "sphere").replace("<length>1</length>", "")
    grid = true_map(room(ball), 0.5, [(0.0, 0.0)], 0.05, 3.0)
    edge = (grid.cells == OCCUPIED)[2:-2, 2:-2]  # the walls are two cells thick
    assert edge[0].all() and edge[-1].all() and edge[:, 0].all() and edge[:, -1].all()


def test_a_post_is_a_ring_of_walls_and_its_inside_unknown(room):
    grid = true_map(room(CYLINDER), 0.3, [(0.0, 0.0)], 0.05, 3.0)
    rows, columns = np.nonzero(grid.cells == OCCUPIED)
    centres = grid.centres_of(np.stack((rows, columns), axis=1))
    ring = np.hypot(*(centres - 0.5).T)
    ring = ring[ring < 0.4]
    assert abs(ring - 0.2).max() < 0.05 * np.sqrt(0.5)
    assert len(ring) == 4 * (2 * 4 - 1)  # what a circle of 4 cells' radius runs through
    assert grid.cells[tuple(grid.cells_of([0.5, 0.5]))] == UNKNOWN

def test_a_slanting_wall_that_is_thinner_than_a_cell_is_tight(room):
    plank = BOX.format(name="plank", pose="0 0 0.5 0 0 0.6", size="4 0.005 1")
    grid = true_map(room(plank), 0.3, [(0.0, 0.5)], 0.1, 3.0)
    assert grid.cells[tuple(grid.cells_of([0.0, 0.5]))] == FREE
    assert grid.cells[tuple(grid.cells_of([0.0, -0.5]))] == UNKNOWN
    both = true_map(room(plank), 0.3, [(0.0, 0.5), (0.0, -0.5)], 0.1, 3.0)
    assert both.cells[tuple(both.cells_of([0.0, -0.5]))] == FREE


def test_surfaces_within_others_are_no_walls(room):
    inner = BOX.format(name="inner", pose="0.5 0.5 0.5 0 0 0", size="0.2 0.2 1")
    outer = BOX.format(name="outer", pose="0.5 0.5 0.5 0 0 0", size="0.8 0.8 1")
    alone, around = (true_map(room(*things), 0.3, [(-0.5, -0.5)], 0.05, 3.0)
                     for things in ((outer,), (inner, outer)))
    assert np.array_equal(alone.cells, around.cells)


def test_actors_are_no_walls(room):
    grid = true_map(room(ACTOR), 0.3, [(0.0, 0.0)], 0.1, 3.0)
    assert grid.cells[tuple(grid.cells_of([-0.5, 0.5]))] == FREE


@pytest.mark.parametrize("point", [(1.05, 0.0), (5.0, 0.0)])
def test_a_start_in_a_wall_or_outside(room, point):
    with pytest.raises(ValueError, match="is in a wall, or outside"):
        true_map(room(), 0.3, [point], 0.1, 3.0)


def test_visible_walls(room):
    grid = true_map(room(), 0.3, [(0.0, 0.0)], 0.1, 3.0)
    seen = visible_walls(grid, np.array([[0.05, 0.05, np.pi / 2]]), np.array([0.0, np.pi / 2]), 2.0)
    north, west = grid.cells_of([0.05, 1.05]), grid.cells_of([-1.05, 0.05])
    assert np.argwhere(seen).tolist() == sorted([west.tolist(), north.tolist()])
    assert not visible_walls(grid, np.array([[0.05, 0.05, 0.0]]), np.array([0.0]), 0.5).any()
