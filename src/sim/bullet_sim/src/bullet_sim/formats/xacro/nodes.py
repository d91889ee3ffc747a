"""xacro's changes of its document, in time that grows linearly with its size."""

import itertools
from xml.dom import minidom

NEAR = 50  # children


class Siblings(minidom.NodeList):
    """Children of a node, searched first near the last one found: xacro processes them in order."""

    __slots__ = ("_near",)

    def index(self, node: minidom.Node) -> int:
        """As list.index."""
        near = getattr(self, "_near", 0)
        try:
            found = super().index(node, max(0, near - NEAR), near + NEAR)
        except ValueError:
            found = super().index(node)
        self._near = found
        return found

    def remove(self, node: minidom.Node) -> None:
        """As list.remove."""
        del self[self.index(node)]


def replace_node(
    node: minidom.Node, by: minidom.Node | list[minidom.Node] | None, content_only: bool = False
) -> None:
    """Replaces xacro's: puts `by`, or its content, in place of a node.

    xacro moves the new nodes one by one, and searches for each among all that are there.
    """
    parent, new = node.parentNode, []
    for one in by if isinstance(by, list) else [by] if by is not None else []:
        if content_only:
            new += one.childNodes
            one.childNodes = minidom.NodeList()
        else:
            new.append(one)
    siblings = parent.childNodes
    place = siblings.index(node)
    siblings[place:place + 1] = new
    chain = [node.previousSibling, *new, node.nextSibling]
    for left, right in itertools.pairwise(chain):
        if left is not None:
            left.nextSibling = right
        if right is not None:
            right.previousSibling = left
    for one in new:
        one.parentNode = parent
    node.parentNode = node.previousSibling = node.nextSibling = None
