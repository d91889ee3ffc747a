"""GLSL of the scene: one source, with lighting per corner or per pixel.

The arithmetic of the fixed pipeline (OpenGL 2.1, 2.14.1): emissive + ambient * scene ambient + sum
over lights of diffuse and specular, clamped to 1, times the texture. No gamma. A surface without
highlight under directional lights only is lit per corner, which is the same on flat faces and
leaves little work per pixel. Of a light that casts shadows, a pixel then gets the share that its
shadow map lets through.
"""

from collections.abc import Sequence
from pathlib import Path

MAX_LIGHTS = 8
DIRECTIONAL, POINT, SPOT = 0, 1, 2
LINEAR, EXP, EXP2 = 0, 1, 2

_FOLDER = Path(__file__).resolve().parents[1] / "data/shaders"


def shader(name: str) -> str:
    """The text of a file in data/shaders."""
    return (_FOLDER / name).read_text(encoding="utf-8")


def sources(per_pixel: bool, textured: bool, lights: Sequence[tuple[int, int]], highlight: bool,
            fog: bool, shadows: int) -> dict[str, str]:
    """Arguments of moderngl's `program` for one kind of surface.

    `lights`: the kind of each and its shadow's number, -1: none. They are constants there, as
    llvmpipe computes both branches of every decision per pixel. `highlight`: whether a light has
    one on it. `shadows`: how many lights cast them.
    """
    defined = {"MAX_LIGHTS": MAX_LIGHTS, "POINT": POINT, "SPOT": SPOT, "LIGHTS": len(lights)}
    for name, numbers in zip(("KINDS", "CASTS"), zip(*lights, strict=True), strict=True):
        defined[name] = f"int[LIGHTS]({', '.join(map(str, numbers))})"
    if highlight:
        defined["HIGHLIGHT"] = ""
    if fog:
        defined |= {"FOG": "", "LINEAR": LINEAR, "EXP": EXP}
    if shadows:
        defined["SHADOWS"] = shadows
    if per_pixel:
        defined["PER_PIXEL"] = ""
    if textured:
        defined["TEXTURED"] = ""
    defines = "".join(f"#define {name} {value}\n" for name, value in defined.items())
    head = "#version 330\n" + defines + shader("lighting.glsl")
    return {"vertex_shader": head + shader("surface.vert"),
            "fragment_shader": head + shader("surface.frag")}
