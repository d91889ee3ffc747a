"""A binary heap in two arrays: lowest key first; equal keys by item, so that runs repeat."""

from __future__ import annotations

from nav_algorithms.compiled import compiled


@compiled("i8(f8[::1], i8[::1], i8, f8, i8)")
def push(keys, items, count, key, item):
    """Add an item to `count` of them, if there is room. Returns the new count."""
    at = count
    while at > 0:
        above = (at - 1) >> 1
        if keys[above] < key or (keys[above] == key and items[above] <= item):
            break
        keys[at], items[at] = keys[above], items[above]
        at = above
    keys[at], items[at] = key, item
    return count + 1


@compiled("i8(f8[::1], i8[::1], i8)")
def pop(keys, items, count):
    """Remove the first, keys[0] and items[0], which must be read before. Returns the new count."""
    count -= 1
    key, item = keys[count], items[count]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= count:
            break
        if below + 1 < count and (keys[below + 1] < keys[below] or (
                keys[below + 1] == keys[below] and items[below + 1] < items[below])):
            below += 1
        if key < keys[below] or (key == keys[below] and item <= items[below]):
            break
        keys[at], items[at] = keys[below], items[below]
        at = below
    keys[at], items[at] = key, item
    return count
