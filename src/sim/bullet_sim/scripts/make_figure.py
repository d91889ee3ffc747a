"""Draws images/overview.svg, the README's picture: make_figure.py [FILE]."""

import sys
from pathlib import Path
from xml.sax.saxutils import escape

FILE = Path(__file__).resolve().parents[1] / "images" / "overview.svg"
BOX, GAP, LEFT = (150, 62), 26, 16  # px: width and height; between boxes; margin
ROWS = (
    ("A file becomes bodies", (
        ("URDF, SDF, xacro", "text"),
        ("formats/", "XML; URDF as SDF"),
        ("description/", "frozen dataclasses"),
        ("physics/assembly.py", "trees of links"),
        ("physics/urdf_text.py", "URDF of one tree"),
        ("PyBullet", "a body"))),
    ("One step of World.step()", (
        ("timed_forces.py", "wrenches that are due"),
        ("model.before_step", "steady forces"),
        ("physics/client.py", "one engine step"),
        ("tick += 1", "simulated time"),
        ("actors.py", "moved by script"),
        ("each_step", "functions of users"))),
    ("Read when asked for, between steps", (
        ("model.pose, .twist", "world axes"),
        ("joint.position", "rad or m"),
        ("sensors/", "readings"),
        ("rendering/scene.py", "frozen for drawing"),
        ("rendering/egl.py", "pictures, depth"),
        ("world.contacts()", "of the last step"))),
)
COLOURS = ("#dbe9f6", "#e3f1dc", "#f9ead2")
PITCH = BOX[1] + 52


def box(x: int, y: int, title: str, note: str, colour: str) -> list[str]:
    """A titled rectangle."""
    middle = x + BOX[0] // 2
    return [
        f'<rect x="{x}" y="{y}" width="{BOX[0]}" height="{BOX[1]}" rx="6" fill="{colour}" '
        'stroke="#556"/>',
        f'<text x="{middle}" y="{y + 26}" text-anchor="middle" font-weight="bold">'
        f"{escape(title)}</text>",
        f'<text x="{middle}" y="{y + 46}" text-anchor="middle">{escape(note)}</text>',
    ]


def drawing() -> str:
    """The SVG; arrows join the boxes of the first two rows, which are sequences."""
    width = 2 * LEFT + 6 * BOX[0] + 5 * GAP
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{len(ROWS) * PITCH + 8}" '
        'font-family="sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="white"/>',
        '<marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" '
        'orient="auto"><path d="M0,0 L8,4 L0,8 z" fill="#334"/></marker>',
    ]
    for row, (heading, boxes) in enumerate(ROWS):
        y = row * PITCH + 34
        lines.append(f'<text x="{LEFT}" y="{y - 10}" font-size="14">{escape(heading)}</text>')
        for column, (title, note) in enumerate(boxes):
            x = LEFT + column * (BOX[0] + GAP)
            lines += box(x, y, title, note, COLOURS[row])
            if column and row < 2:
                lines.append(f'<path d="M{x - GAP},{y + BOX[1] // 2} h{GAP}" stroke="#334" '
                             'marker-end="url(#tip)"/>')
    return "\n".join([*lines, "</svg>", ""])


if __name__ == "__main__":
    Path(sys.argv[1] if len(sys.argv) > 1 else FILE).write_text(drawing(), encoding="utf-8")
