"""Reads the `<camera>` of an SDF sensor: image, clip, noise, distortion and wide-angle lens."""

from xml.etree.ElementTree import Element

from bullet_sim.description import CameraDescription, Lens
from bullet_sim.errors import FormatError
from bullet_sim.formats.mistakes import instead
from bullet_sim.formats.sdf.noise import read_noise
from bullet_sim.formats.xml_values import (
    child_text,
    fields,
    flag,
    integer,
    number,
    pose,
    shown,
    vector,
)

DISTORTION = ("k1", "k2", "p1", "p2", "k3")  # the order of OpenCV and of camera_info
LENSES = {  # type: c1, c2, function of r = c1 f fun(theta / c2)
    "gnomonical": (1.0, 1.0, "tan"),
    "stereographic": (2.0, 2.0, "tan"),
    "equidistant": (1.0, 1.0, "id"),
    "equisolid_angle": (2.0, 2.0, "sin"),
    "orthographic": (1.0, 1.0, "sin"),
}
USUAL_LENS = "stereographic"
FUNCTIONS = ("sin", "tan", "id")


def read_camera(element: Element, sensor: str) -> CameraDescription:
    """One camera; `sensor` names its sensor in errors."""
    name = element.get("name", "")
    where = f"{sensor} <camera name={name!r}>" if name else f"{sensor} <camera>"
    usual = CameraDescription()
    return CameraDescription(
        name=name,
        pose=pose(element, where),
        horizontal_fov=number(element, "horizontal_fov", usual.horizontal_fov, where),
        **fields(integer, element, "width height", usual, where, "image/"),
        format=child_text(element, "image/format", usual.format),
        **fields(number, element, "near far", usual, where, "clip/"),
        noise=read_noise(element.find("noise"), where),
        distortion=tuple(number(element, f"distortion/{key}", 0.0, where) for key in DISTORTION),
        distortion_centre=vector(element, "distortion/center", usual.distortion_centre, where),
        lens=_lens(element.find("lens"), f"{where} <lens>"),
    )


def _lens(element: Element | None, where: str) -> Lens:
    if element is None:
        return Lens()
    usual = Lens()
    kind = child_text(element, "type", USUAL_LENS)
    own = "custom_function/"
    if kind == "custom":
        function = child_text(element, own + "fun", usual.function)
        c1 = number(element, own + "c1", 1.0, where)
        c2 = number(element, own + "c2", 1.0, where)
    elif kind in LENSES:
        c1, c2, function = LENSES[kind]
    else:
        c1, c2, function = LENSES[USUAL_LENS]
        instead(FormatError(f"{where} <type>: no lens named {kind!r}; there are: "
                            f"{', '.join(LENSES)}, custom"), shown(USUAL_LENS))
    if function not in FUNCTIONS:
        instead(FormatError(f"{where} <fun>: no function named {function!r}; there are: "
                            f"{', '.join(FUNCTIONS)}"), shown(usual.function))
        function = usual.function
    return Lens(
        c1=c1,
        c2=c2,
        function=function,
        **(fields(number, element, "c3 f", usual, where, own) if kind == "custom" else {}),
        scale_to_hfov=flag(element, "scale_to_hfov", usual.scale_to_hfov),
        cutoff_angle=number(element, "cutoff_angle", usual.cutoff_angle, where),
        env_texture_size=integer(element, "env_texture_size", usual.env_texture_size, where),
    )
