"""The picture that shows the error in a drawing."""

from __future__ import annotations

import cv2
import numpy as np

from racecar_description.track.errors import DrawingError

LEAST_PX = 480  # longer side: small drawings are enlarged
RED, PAPER, INK = (40, 30, 230), (245, 245, 245), (30, 30, 30)  # BGR
FONT = cv2.FONT_HERSHEY_DUPLEX
LINE_PX = 26


def draw_problem(error: DrawingError) -> np.ndarray:
    """BGR: the drawing, faded, with marks in red and the message below."""
    picture = error.picture
    larger = max(1.0, LEAST_PX / max(picture.shape[:2]))
    size = (round(picture.shape[1] * larger), round(picture.shape[0] * larger))
    page = cv2.resize(picture, size, interpolation=cv2.INTER_NEAREST)
    page = (page * 0.6 + 255 * 0.4).astype(np.uint8)
    radius = max(16, round(0.04 * max(size)))
    for mark in error.marks:
        centre = (round((mark.x_px + 0.5) * larger), round((mark.y_px + 0.5) * larger))
        cv2.circle(page, centre, radius, RED, max(3, radius // 8), cv2.LINE_AA)
        text_width = cv2.getTextSize(mark.text, FONT, 0.7, 1)[0][0]
        x = min(max(4, centre[0] - text_width // 2), max(4, size[0] - text_width - 4))
        y = centre[1] - radius - 10 if centre[1] > radius + 34 else centre[1] + radius + 28
        cv2.putText(page, mark.text, (x, y), FONT, 0.7, (255, 255, 255), 4, cv2.LINE_AA)
        cv2.putText(page, mark.text, (x, y), FONT, 0.7, RED, 1, cv2.LINE_AA)
    lines = _wrapped(str(error), size[0] - 20)
    foot = np.full((LINE_PX * len(lines) + 16, size[0], 3), PAPER, np.uint8)
    for row, line in enumerate(lines):
        at = (10, LINE_PX * (row + 1))
        cv2.putText(foot, line, at, FONT, 0.55, INK, 1, cv2.LINE_AA)
    return np.vstack((page, foot))


def _wrapped(text: str, width_px: int) -> list[str]:
    """The text in lines that fit; cv2 only draws ASCII."""
    lines = [""]
    for word in text.encode("ascii", "replace").decode().split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and cv2.getTextSize(longer, FONT, 0.55, 1)[0][0] > width_px:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines
