"""Draws what was seen and decided into the image."""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.lane import Lane, Side
from lane_keeping.lane_keeper import Decision
from lane_keeping.road_view import RoadView

GREEN, RED, BLUE, YELLOW, CYAN, MAGENTA, BLACK = (
    (0, 220, 0), (0, 0, 255), (255, 80, 0), (0, 230, 255), (255, 220, 0), (255, 0, 255), (0, 0, 0),
)
BGR = tuple[int, int, int]


def annotate(image: np.ndarray, decision: Decision) -> np.ndarray:
    """Draw into a BGR image (h, w, 3), which is modified and returned."""
    view = decision.view
    if view is not None:
        cv2.line(image, (0, view.top), (view.width - 1, view.top), YELLOW, 1)
        _draw_crossing(image, decision, view)
    if decision.plan is not None:
        _draw_lane(image, decision.plan.lane, view.top)
        column, row = decision.plan.target
        cv2.circle(image, (_px(column), _px(row) + view.top), 7, RED, -1)
    for i, text in enumerate(_texts(decision)):
        place = (10, 24 + 22 * i)
        cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.6, BLACK, 3)
        cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.6, YELLOW, 1)
    return image


def _texts(decision: Decision) -> list[str]:
    texts = [f"{decision.state}  {decision.speed:.2f} m/s  {decision.turn:+.2f} rad/s"]
    if decision.plan is not None:
        plan = decision.plan
        texts.append(f"error {plan.error:+.3f}  curvature {plan.curvature:.5f} 1/px")
    if decision.zebra is not None:
        near = decision.zebra.near
        texts.append(f"zebra in {near:.2f} m" if near > 0 else "on a zebra")
    return texts


def _draw_lane(image: np.ndarray, lane: Lane, top: int) -> None:
    for left, high, right, low in lane.marks.boxes:
        cv2.rectangle(image, (left, high + top), (right, low + top), GREEN, 1)
    if lane.marks.points is not None:
        for column, row in lane.marks.points:
            cv2.circle(image, (_px(column), _px(row) + top), 3, GREEN, 1)
    for side, colour in ((lane.left, BLUE), (lane.right, BLUE), (lane.centre, RED)):
        if side is not None:
            _draw_side(image, side, colour, top)


def _draw_side(image: np.ndarray, side: Side, colour: BGR, top: int) -> None:
    rows = np.linspace(*side.rows, 20)
    points = np.stack([np.polyval(side.curve, rows), rows + top], axis=1)
    points = np.clip(points, -4000, 4000)
    cv2.polylines(image, [np.rint(points).astype(np.int32)], False, colour, 2)


def _draw_crossing(image: np.ndarray, decision: Decision, view: RoadView) -> None:
    if decision.zebra is not None:
        ends = np.array([[decision.zebra.near, 0.6], [decision.zebra.near, -0.6]])
        ends = view.to_picture(ends)
        if np.isfinite(ends).all():
            a, b = np.rint(np.clip(ends, -4000, 4000)).astype(int).tolist()
            cv2.line(image, a, b, CYAN, 3)
    for feet in decision.people:
        base, head = view.to_picture(feet), view.to_picture(feet, 2 * view.lens_height)
        if np.isfinite([base, head]).all():
            half = abs(base[1] - head[1]) / 6
            a, b = (base[0] - half, head[1]), (base[0] + half, base[1])
            cv2.rectangle(image, (_px(a[0]), _px(a[1])), (_px(b[0]), _px(b[1])), MAGENTA, 2)


def _px(value: float) -> int:
    """A coordinate that OpenCV can draw, however far outside the image."""
    return int(np.clip(round(value), -4000, 4000))
