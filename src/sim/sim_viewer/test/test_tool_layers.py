"""The graph's layout: columns follow the arrows, rows keep apart."""

from itertools import combinations

from sim_viewer.tools.layers import layout


def test_a_chain_goes_from_left_to_right_in_one_row():
    plan = layout("abc", [("a", "b"), ("b", "c")])
    assert plan.cells == {"a": (0, 0.0), "b": (1, 0.0), "c": (2, 0.0)}


def test_a_long_arrow_passes_each_column_beside_what_stands_there():
    plan = layout("abc", [("a", "b"), ("b", "c"), ("a", "c")])
    route = plan.routes["a", "c"]
    assert [column for column, _ in route] == [0, 1, 2]
    assert abs(route[1][1] - plan.cells["b"][1]) >= 1


def test_a_circle_has_one_arrow_back():
    edges = [("a", "b"), ("b", "c"), ("c", "a")]
    plan = layout("abc", edges)
    back = [edge for edge in edges if plan.cells[edge[0]][0] > plan.cells[edge[1]][0]]
    assert len(back) == 1
    source, target = back[0]
    assert plan.routes[back[0]][0] == plan.cells[source]
    assert plan.routes[back[0]][-1] == plan.cells[target]


def test_a_source_stands_next_to_what_it_feeds():
    plan = layout("abcd", [("a", "b"), ("b", "c"), ("d", "c")])
    assert plan.cells["d"][0] == plan.cells["b"][0] == 1


def test_crossings_are_undone():
    plan = layout(["a", "b", "x", "y"], [("a", "y"), ("b", "x")])
    assert (plan.cells["a"][1] < plan.cells["b"][1]) == (plan.cells["y"][1] < plan.cells["x"][1])


def test_nothing_stands_on_anything_else():
    names = [f"n{i}" for i in range(40)]
    edges = [(f"n{i}", f"n{(i * 7 + k) % 40}") for i in range(40) for k in (1, 5)]
    plan = layout(names, edges)
    for (_, one), (_, other) in combinations(plan.cells.items(), 2):
        assert one[0] != other[0] or abs(one[1] - other[1]) >= 0.99
    assert min(row for _, row in plan.cells.values()) >= 0


def test_a_loop_on_itself_and_an_unknown_end_are_left_out():
    plan = layout("a", [("a", "a"), ("a", "missing")])
    assert plan.cells == {"a": (0, 0.0)}
    assert plan.routes == {}
