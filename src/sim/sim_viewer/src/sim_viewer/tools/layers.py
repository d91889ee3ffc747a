"""Places for the nodes of a directed graph: columns from left to right, few edges crossing."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

SWEEPS = 6  # orderings settle after four to six
Edge = tuple[str, str]
Cell = tuple[int, float]  # column, row


@dataclass(frozen=True)
class Layout:
    """Where nodes stand and edges pass; columns and rows count from 0. Loops have no route."""

    cells: dict[str, Cell]
    routes: dict[Edge, list[Cell]]  # from source to target, with one cell in each column between


def layout(nodes: Iterable[str], edges: Iterable[Edge]) -> Layout:
    """Layered drawing after Sugiyama, Tagawa and Toda (1981): cycles, layers, crossings, places."""
    names = sorted(set(nodes))
    known = set(names)
    wanted = sorted({edge for edge in edges if edge[0] in known and edge[1] in known})
    backward = _back_edges(names, wanted)
    forward = {edge: edge[::-1] if edge in backward else edge
               for edge in wanted if edge[0] != edge[1]}
    column = _columns(names, set(forward.values()))
    chains = {pair: _chain(pair, column) for pair in sorted(set(forward.values()))}
    links = [link for chain in chains.values() for link in pairwise(chain)]
    order = _order(column, links)
    rows = _rows(order, links)
    cells = {name: (column[name], rows[name]) for name in names}
    routes = {}
    for edge, pair in forward.items():
        route = [(column[point], rows[point]) for point in chains[pair]]
        routes[edge] = route if pair == edge else route[::-1]
    return Layout(cells, routes)


def _back_edges(names: list[str], edges: list[Edge]) -> set[Edge]:
    """Edges that close a cycle when one walks depth first, beginning at nodes nothing leads to."""
    targets: dict[str, list[str]] = {name: [] for name in names}
    fed = set()
    for source, target in edges:
        targets[source].append(target)
        fed.add(target)
    back, done, path = set(), set(), set()
    for start in [n for n in names if n not in fed] + names:
        stack = [(start, iter(targets[start]))] if start not in done else []
        path.update([start] if stack else [])
        while stack:
            node, rest = stack[-1]
            target = next(rest, None)
            if target is None:
                stack.pop()
                path.discard(node)
                done.add(node)
            elif target in path:
                back.add((node, target))
            elif target not in done:
                path.add(target)
                stack.append((target, iter(targets[target])))
    return back


def _columns(names: list[str], edges: set[Edge]) -> dict[str, int]:
    """Longest path from a source; sources then move right, next to what they feed."""
    incoming: dict[str, list[str]] = {name: [] for name in names}
    outgoing: dict[str, list[str]] = {name: [] for name in names}
    for source, target in sorted(edges):
        incoming[target].append(source)
        outgoing[source].append(target)
    waiting = {name: len(incoming[name]) for name in names}
    ready = [name for name in names if not waiting[name]]
    column = dict.fromkeys(names, 0)
    for node in ready:  # grows while it is walked: Kahn's order
        for target in outgoing[node]:
            column[target] = max(column[target], column[node] + 1)
            waiting[target] -= 1
            if not waiting[target]:
                ready.append(target)
    for node in reversed(ready):
        if outgoing[node] and not incoming[node]:
            column[node] = min(column[target] for target in outgoing[node]) - 1
    return column


def _chain(edge: Edge, column: dict[str, int]) -> list[str]:
    """Source, one made-up point in each column between, target; the points enter `column`."""
    source, target = edge
    points = []
    for between in range(column[source] + 1, column[target]):
        point = f"{source}\n{target}\n{between}"  # no ROS name has a line break
        column[point] = between
        points.append(point)
    return [source, *points, target]


def _order(column: dict[str, int], links: list[Edge]) -> list[list[str]]:
    """Each column's points from top to bottom: sweeps of barycentres, right and left in turn."""
    columns: list[list[str]] = [[] for _ in range(max(column.values(), default=-1) + 1)]
    for point in sorted(column):
        columns[column[point]].append(point)
    left, right = _neighbours(column, links)
    for sweep in range(SWEEPS):
        near = left if sweep % 2 == 0 else right
        walk = columns if sweep % 2 == 0 else columns[::-1]
        place = {point: i for points in columns for i, point in enumerate(points)}
        for points in walk:
            weight = {p: _mean([place[n] for n in near[p]], place[p]) for p in points}
            points.sort(key=lambda point: (weight[point], point))
            place.update({point: i for i, point in enumerate(points)})
    return columns


def _rows(columns: list[list[str]], links: list[Edge]) -> dict[str, float]:
    """A row for each point: near the mean of its neighbours, at least one row apart in a column."""
    column = {point: i for i, points in enumerate(columns) for point in points}
    left, right = _neighbours(column, links)
    tallest = max((len(points) for points in columns), default=0)
    row = {point: i + (tallest - len(points)) / 2
           for points in columns for i, point in enumerate(points)}
    for sweep in range(SWEEPS):
        for points in columns if sweep % 2 == 0 else columns[::-1]:
            wish = [_mean([row[n] for n in left[p] + right[p]], row[p]) for p in points]
            row.update(zip(points, _spread(wish)))
    top = min(row.values(), default=0.0)
    return {point: round(value - top, 3) for point, value in row.items()}


def _spread(wish: list[float]) -> list[float]:
    """Rows in the same order and one apart: runs that overlap share their mean shift."""
    runs: list[list[float]] = []  # [sum of shifts, count] of neighbours that touch
    for i, value in enumerate(wish):
        runs.append([value - i, 1])
        while len(runs) > 1 and runs[-2][0] / runs[-2][1] > runs[-1][0] / runs[-1][1]:
            total, count = runs.pop()
            runs[-1] = [runs[-1][0] + total, runs[-1][1] + count]
    shifts = [total / count for total, count in runs for _ in range(int(count))]
    return [i + shift for i, shift in enumerate(shifts)]


def _neighbours(column: dict[str, int], links: list[Edge]) -> tuple[dict, dict]:
    left: dict[str, list[str]] = {point: [] for point in column}
    right: dict[str, list[str]] = {point: [] for point in column}
    for source, target in links:
        left[target].append(source)
        right[source].append(target)
    return left, right


def _mean(values: list[float], default: float) -> float:
    return sum(values) / len(values) if values else default
