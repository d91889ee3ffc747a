"""Finds the parts of a scene that may be in the image, and the order in which to draw them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bullet_sim.meshes.part import box_corners
from bullet_sim.rendering.scene import LinkShape, Node


@dataclass(frozen=True)
class Visibility:
    """For one image; row i of an array belongs to the scene's node i."""

    clip_node: np.ndarray  # (n, 4, 4), node frame to clip coordinates
    parts: list[np.ndarray]  # for each node, whether each of its parts may be visible
    depths: list[np.ndarray]  # m, of each of these parts' nearest corner from the camera
    order: list[int]  # nodes, nearest first; of those around the camera, small first


class Outlines:
    """Boxes around the parts of all nodes, tested against a view in one go."""

    def __init__(self, shapes: Sequence[LinkShape]):
        boxes = [box_corners(part) for shape in shapes for part in shape.parts]
        self._corners = np.array(boxes).reshape(-1, 4, 8)
        counts = [len(shape.parts) for shape in shapes]
        self._owner = np.repeat(np.arange(len(shapes)), counts)
        self._ends = np.cumsum(counts)[:-1]
        self._centres = np.array([[*shape.centre, 1.0] for shape in shapes]).reshape(-1, 4, 1)
        self._radii = np.array([shape.radius for shape in shapes])

    def seen(self, nodes: Sequence[Node], clip_world: np.ndarray, eye: np.ndarray) -> Visibility:
        """`clip_world` (4, 4) is world to clip coordinates, `eye` (3,) the camera's position."""
        world_node = np.array([node.matrix for node in nodes]).reshape(-1, 4, 4)
        clip_node = clip_world @ world_node
        clip = clip_node[self._owner] @ self._corners
        axes, w = clip[:, :3], clip[:, 3:]
        # Outside if all corners are beyond the same side of the view.
        outside = (axes < -w).all(axis=2) | (axes > w).all(axis=2)
        parts = self.by_node(~outside.any(axis=1))
        depths = self.by_node(clip[:, 3].min(axis=1))
        centres = (world_node @ self._centres)[:, :3, 0]
        gaps = np.maximum(0.0, np.linalg.norm(centres - eye, axis=1) - self._radii)
        order = np.lexsort((self._radii, gaps)).tolist()
        return Visibility(clip_node, parts, depths,
                          [index for index in order if parts[index].any()])

    def boxes(self, nodes: Sequence[Node]) -> np.ndarray:
        """(n, 8, 3): corners in the world of boxes around every part of every node."""
        world_node = np.array([node.matrix for node in nodes]).reshape(-1, 4, 4)
        return (world_node[self._owner] @ self._corners)[:, :3].swapaxes(1, 2)

    def by_node(self, of_parts: np.ndarray) -> list[np.ndarray]:
        """Splits a value per part into an array for each node."""
        return np.split(of_parts, self._ends)
