"""What counts as getting nearer to the goal."""

import numpy as np

from move_base.navigator import Progress

PATH = np.column_stack((np.linspace(0, 2, 41), np.zeros(41), np.zeros(41)))


def on_the_way(path=PATH):
    progress = Progress()
    progress.take(path)
    return progress


def nearer(progress, x, yaw=0.0, y=0.0):
    return progress.is_nearer(np.array([x, y, yaw]))


def test_every_five_centimetres_count():
    progress = on_the_way()
    assert [nearer(progress, x) for x in (0, 0.04, 0.1, 0.12, 0.2, 0.5)] == [
        True, False, True, False, True, True]


def test_to_and_fro_does_not():
    progress = on_the_way(PATH[30:])
    assert nearer(progress, 1.85)
    assert not any(nearer(progress, x, yaw) for x in (1.8, 1.7, 1.85, 1.88) for yaw in (0.2, 0.0))


def test_turning_counts_beside_the_goal_only():
    progress = on_the_way()
    assert [nearer(progress, 1.0, yaw) for yaw in (3, 2, 1)] == [True, False, False]
    assert [nearer(progress, 1.9, yaw) for yaw in (3, 2.5, 2.4, 2.1)] == [True, True, False, True]


def test_a_detour_is_the_new_measure_but_no_progress():
    progress = on_the_way()
    assert nearer(progress, 1.0)
    progress.take(np.vstack((PATH[20::-1], PATH + np.array([0, 0.5, 0]), PATH[-1])))
    assert [nearer(progress, x) for x in (1.0, 0.9, 0.5)] == [False, True, True]


def test_newer_paths_change_nothing_and_a_new_goal_begins_anew():
    progress = on_the_way()
    assert nearer(progress, 1.0)
    progress.take(PATH[18:])
    assert not nearer(progress, 0.98)
    progress.begin()
    progress.take(PATH)
    assert nearer(progress, 0.5)
