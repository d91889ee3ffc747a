"""Obstacles that sensors saw, in two and three dimensions."""

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap import footprint
from nav_algorithms.costmap.costs import FREE, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.layered import LayeredCostmap
from nav_algorithms.costmap.obstacles import Observation, ObstacleLayer
from nav_algorithms.costmap.tracing import clear_voxels, draw_lines, fill_polygon
from nav_algorithms.costmap.voxels import VoxelLayer, VoxelSettings

HERE = np.array([2.05, 2.05, 0.0])


def seen(*points, origin=(2.05, 2.05, 0.2), obstacle_range=2.5, raytrace_range=3.0):
    return Observation(np.array(origin), np.array(points, float).reshape(-1, 3), obstacle_range,
                       raytrace_range)


def costmap_of(layer, **settings):
    return LayeredCostmap([layer], (41, 41), 0.1, (0.0, 0.0), **settings)


def update(layered, marking=(), clearing=(), pose=HERE):
    layered.layers[0].observe(marking, clearing)
    layered.update(pose)
    return layered.master.cells


def test_lines_are_of_one_cell_a_step_and_pass_over_the_outside():
    cells = np.zeros((5, 7), np.uint8)
    draw_lines(cells, 1, 1, np.array([1, 3, 9]), np.array([5, 5, 1]), 1)
    assert cells.tolist() == [[0, 0, 0, 0, 0, 0, 0], [0, 1, 1, 1, 1, 1, 0], [0, 1, 0, 1, 1, 0, 0],
                              [0, 1, 0, 0, 0, 1, 0], [0, 1, 0, 0, 0, 0, 0]]


@pytest.mark.parametrize("end", [(0, 0), (0, 9), (9, 0), (9, 9), (2, 9), (9, 2), (4, 0), (0, 4)])
def test_lines_go_from_end_to_end(end):
    cells = np.zeros((10, 10), np.uint8)
    draw_lines(cells, 4, 4, np.array([end[0]]), np.array([end[1]]), 1)
    assert cells[4, 4] and cells[end]
    assert cells.sum() == max(abs(end[0] - 4), abs(end[1] - 4)) + 1


def test_a_polygon_covers_every_cell_that_the_footprint_looks_at():
    generator = np.random.default_rng(3)
    outline = np.array([[0.31, 0.12], [-0.2, 0.17], [-0.25, -0.1], [0.3, -0.2]])
    for _ in range(50):
        pose = np.array([*generator.uniform(0.6, 3.4, 2), generator.uniform(-4, 4)])
        cos, sin = np.cos(pose[2]), np.sin(pose[2])
        corners = outline @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
        cells = np.full((40, 40), LETHAL, np.uint8)
        fill_polygon(cells, corners / 0.1, FREE)
        assert footprint.costs(Costmap(cells, 0.1, (0.0, 0.0)), outline, pose).tolist() == [0]
        assert (cells == FREE).sum() < 60  # its area is 16 cells, its rim at most 30


def test_a_polygon_beside_the_grid_writes_nothing():
    cells = np.zeros((4, 4), np.uint8)
    fill_polygon(cells, np.array([[-3.0, 1], [-2, 1], [-2, 3]]), 1)
    fill_polygon(cells, np.array([[1.0, 9], [2, 9], [2, 11]]), 1)
    assert not cells.any()
    fill_polygon(cells, np.array([[-3.0, -3], [9, -3], [9, 9], [-3, 9]]), 1)
    assert cells.all()


def test_an_obstacle_is_marked_kept_and_cleared_by_a_ray_through_it():
    layered = costmap_of(ObstacleLayer("obstacles"))
    wall, behind = seen((3.05, 2.05, 0.2)), seen((3.55, 2.05, 0.2))
    assert update(layered, [wall], [wall])[20, 30] == LETHAL
    assert update(layered)[20, 30] == LETHAL
    cells = update(layered, [behind], [behind])
    assert cells[20, 30] == FREE and cells[20, 35] == LETHAL
    assert (cells > 0).sum() == 1


def test_unknown_space_is_what_no_ray_went_through():
    layered = costmap_of(ObstacleLayer("obstacles", track_unknown=True), track_unknown=True)
    wall = seen((3.05, 2.05, 0.2))
    cells = update(layered, [wall], [wall])
    assert (cells[20, 20:30] == FREE).all() and cells[20, 30] == LETHAL
    assert (cells == UNKNOWN).sum() == cells.size - 11


def test_ranges_of_marking_and_clearing():
    layered = costmap_of(ObstacleLayer("obstacles", track_unknown=True), track_unknown=True)
    far = seen((3.95, 2.05, 0.2), obstacle_range=1.5, raytrace_range=1.0)
    cells = update(layered, [far], [far])
    assert (cells[20, 20:31] == FREE).all() and (cells[20, 31:] == UNKNOWN).all()
    beside = seen((2.05, 3.54, 0.2), obstacle_range=1.5)
    assert update(layered, [beside])[35, 20] == LETHAL


def test_rays_end_outside_the_costmap_and_begin_there():
    layered = costmap_of(ObstacleLayer("obstacles", track_unknown=True), track_unknown=True)
    through = seen((9.0, 2.05, 0.2), raytrace_range=20.0)
    cells = update(layered, [through], [through])
    assert (cells[20, 20:] == FREE).all()
    into = seen((1.05, 1.05, 0.2), origin=(-1.0, 1.05, 0.2), raytrace_range=20.0)
    assert (update(layered, [], [into])[10, :11] == FREE).all()
    nothing = seen(origin=(2.0, 2.0, 0.0))
    update(layered, [nothing], [nothing])


def test_a_layer_that_is_switched_on_writes_what_it_sees_alone():
    layered = costmap_of(layer := ObstacleLayer("obstacles"))
    layer.enabled = False
    layered.update(HERE)
    layer.enabled = True
    layer.observe([seen((3.05, 2.55, 0.2))], [])
    assert layered.update(HERE) == (slice(25, 26), slice(30, 31))


@pytest.mark.parametrize("layer", [ObstacleLayer("o"), VoxelLayer("v", of(VoxelSettings))])
@pytest.mark.parametrize("edge", [0.05, 4.05])
@pytest.mark.parametrize("axis", [0, 1])
def test_obstacles_along_the_edges_are_cleared_too(layer, edge, axis):
    def at(way):
        return (edge, way, 0.1) if axis == 0 else (way, edge, 0.1)

    layered = costmap_of(layer)
    wall, behind = seen(at(3.05), origin=at(2.05)), seen(at(3.85), origin=at(2.05))
    cell = tuple(layered.master.cells_of(at(3.05)[:2]))
    assert update(layered, [wall])[cell] == LETHAL
    assert update(layered, [], [behind])[cell] == FREE


def test_rays_among_voxels_change_nothing_that_lies_beyond_the_grid():
    marked, unseen = np.full((2, 12, 4), 7, np.uint16)  # two levels, and the grid in the midst
    cells = np.full((12, 4), LETHAL, np.uint8)
    middle = np.array([2.0, 3.0, 0.5])  # column, row, level
    ends = middle + np.array([[-9, 0, 0], [9, 0, 0], [0, -7, 0], [0, 7, 0], [0, 0, 9], [0, 0, -9]])
    clear_voxels(marked[3:9], unseen[3:9], cells[3:9], middle, ends, 2, 1, 1)
    expected = np.full((12, 4), 7)
    expected[6, :] = expected[3:9, 2] = 6  # the lower of the two is gone
    expected[6, 2] = 4
    assert (marked == expected).all() and (unseen == expected).all()
    assert np.argwhere(cells == FREE).tolist() == [[6, 2]] and (cells == LETHAL).sum() == 47


def test_what_is_too_high_is_no_obstacle():
    layered = costmap_of(ObstacleLayer("obstacles", max_obstacle_height=0.5))
    assert not update(layered, [seen((3.0, 2.0, 0.6))]).any()
    assert update(layered, [seen((3.0, 2.0, 0.4))]).any()


@pytest.mark.parametrize("clears", [True, False])
def test_where_the_robot_stands(clears):
    layered = costmap_of(ObstacleLayer("obstacles", clears_footprint=clears))
    layered.set_footprint(footprint.circle(0.2))
    cells = update(layered, [seen((2.15, 2.05, 0.1), (3.05, 2.05, 0.1))])
    assert cells[20, 30] == LETHAL and (cells[20, 21] == FREE) == clears


def test_the_robot_drives_over_what_was_an_obstacle():
    layered = costmap_of(ObstacleLayer("obstacles"))
    layered.set_footprint(footprint.circle(0.2))
    assert update(layered, [seen((3.05, 2.05, 0.1))])[20, 30] == LETHAL
    assert update(layered, pose=np.array([3.0, 2.05, 0.0]))[20, 30] == FREE


def test_obstacles_stay_in_the_world_when_the_window_rolls():
    layered = costmap_of(ObstacleLayer("obstacles"), rolling=True)
    update(layered, [seen((3.05, 2.05, 0.2))])
    cells = update(layered, pose=np.add(HERE, (0.5, -0.3, 0.0)))
    found = layered.master.centres_of(np.argwhere(cells == LETHAL))
    assert found == pytest.approx(np.array([[3.05, 2.05]]), abs=0.1)
    update(layered, pose=np.add(HERE, (9.0, 0.0, 0.0)))
    assert not update(layered).any()


@pytest.mark.parametrize("layer", [ObstacleLayer("o"), VoxelLayer("v", of(VoxelSettings))])
def test_forgetting(layer):
    layered = costmap_of(layer)
    sides = np.array([[0, -1, 0], [-1, 0, 0], [1, 0, 0], [0, 1, 0]])
    near, far = HERE + 0.9 * sides, HERE + 1.1 * sides
    for invert, left in ((False, near), (True, far)):
        update(layered, [seen(*near, *far)])
        layer.clear_area(HERE[:2] - 1, HERE[:2] + 1, invert)
        assert np.argwhere(update(layered)).tolist() == layer.own.cells_of(left[:, :2]).tolist()
    layered.reset()
    assert not update(layered).any()


def test_a_voxel_is_cleared_only_at_its_height():
    layered = costmap_of(VoxelLayer("voxels", of(VoxelSettings)))
    update(layered, [seen((3.05, 2.05, 0.9), origin=(2.05, 2.05, 0.9))])
    low = seen((3.85, 2.05, 0.1), origin=(2.05, 2.05, 0.1))
    assert update(layered, [], [low])[20, 30] == LETHAL
    high = seen((3.85, 2.05, 0.9), origin=(2.05, 2.05, 0.9))
    assert update(layered, [], [high])[20, 30] == FREE


def test_rays_among_voxels_spare_what_is_beside_their_end():
    layered = costmap_of(VoxelLayer("voxels", of(VoxelSettings)))
    update(layered, [seen((3.05, 2.05, 0.1), origin=(2.05, 2.05, 0.1))])
    for end, expected in ((3.15, LETHAL), (3.35, FREE)):
        ray = seen((end, 2.05, 0.1), origin=(2.05, 2.05, 0.1))
        assert update(layered, [], [ray])[20, 30] == expected


def test_a_marked_voxel_is_a_seen_one():
    settings = of(VoxelSettings, z_voxels=3, unknown_threshold=1, mark_threshold=1)
    layered = costmap_of(VoxelLayer("voxels", settings, track_unknown=True), track_unknown=True)
    update(layered, [seen((3.05, 2.05, 0.1))])
    ray = seen((3.85, 2.05, 0.3), origin=(2.05, 2.05, 0.3))
    assert update(layered, [], [ray])[20, 30] == FREE


def test_voxels_need_more_marks_than_the_threshold():
    layered = costmap_of(VoxelLayer("voxels", of(VoxelSettings, mark_threshold=1)))
    one, two = (3.05, 2.05, 0.1), (3.05, 2.05, 0.5)
    assert update(layered, [seen(one, one)])[20, 30] == FREE
    assert update(layered, [seen(two)])[20, 30] == LETHAL
    aside = seen((3.85, 2.05, 0.5), origin=(2.05, 2.05, 0.5))
    assert update(layered, [], [aside])[20, 30] == FREE  # one mark is left


def test_a_column_with_many_unseen_voxels_is_unknown():
    layered = costmap_of(VoxelLayer("voxels", of(VoxelSettings, z_voxels=3, unknown_threshold=1),
                                    track_unknown=True), track_unknown=True)
    for height, expected in ((0.1, UNKNOWN), (0.3, FREE)):
        ray = seen((3.85, 2.05, height), origin=(2.05, 2.05, height))
        assert update(layered, [], [ray])[20, 25] == expected


def test_points_below_the_voxels_count_as_on_the_floor_and_above_not_at_all():
    layered = costmap_of(VoxelLayer("voxels", of(VoxelSettings, z_voxels=2, z_resolution=0.2)))
    assert update(layered, [seen((3.05, 2.05, -0.1))])[20, 30] == LETHAL
    assert update(layered, [seen((3.05, 3.05, 0.5))])[30, 30] == FREE


def test_voxels_stay_in_the_world_and_go_with_other_settings():
    layer = VoxelLayer("voxels", of(VoxelSettings))
    layered = costmap_of(layer, rolling=True)
    update(layered, [seen((3.05, 2.05, 0.9))])
    update(layered, pose=np.add(HERE, (0.5, 0.0, 0.0)))
    cells = update(layered, [], [seen((3.85, 2.05, 0.1), origin=(2.55, 2.05, 0.1))],
                   pose=np.add(HERE, (0.5, 0.0, 0.0)))
    assert (cells == LETHAL).sum() == 1
    layer.change_settings(of(VoxelSettings, mark_threshold=2))
    assert update(layered).any()
    layer.change_settings(of(VoxelSettings, z_resolution=0.1))
    assert not update(layered).any()
