"""One colour scheme for all pictures and videos: colours as #rrggbb."""

PAPER, FLOOR, GRID, TEXT, FAINT = "#181a1e", "#0e0e10", "#24272c", "#e4e8eb", "#989ea5"
LINE, WHITE = "#f5d728", "#e1e1e1"  # the course's line that the car follows, and its other line
LAPS = ("#46aaf0", "#fa6e6e", "#5ad282", "#d278dc", "#fabe5a", "#50c8c8")
CAR, GOOD, BAD, HIDDEN = "#f03c3c", "#5ad282", "#faaa3c", "#6e8296"


def lap_colour(number: int) -> str:
    """The colour of a lap, counted from 0."""
    return LAPS[number % len(LAPS)]


def bgr(colour: str) -> tuple[int, int, int]:
    """Blue, green, red from 0 to 255, as OpenCV has them."""
    return tuple(bytes.fromhex(colour[1:])[::-1])
