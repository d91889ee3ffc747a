"""Reads shapes that are generated, not loaded: `<heightmap>`, `<polyline>`, `<image>`."""

from pathlib import Path
from xml.etree.ElementTree import Element

import bullet_sim.formats.xml_values as xml
from bullet_sim import description
from bullet_sim.errors import FormatError, ResourceNotFound
from bullet_sim.formats.source import Source

IMAGE_KINDS = (".png", ".jpg", ".jpeg", ".bmp", ".pgm", ".tif", ".tiff")
# Colours for textures of Gazebo's media folder, by a word in the file name: we have no textures.
GROUNDS: dict[str, description.Rgba] = {
    "dirt": (0.42, 0.33, 0.24, 1.0),
    "grass": (0.25, 0.42, 0.16, 1.0),
    "fungus": (0.36, 0.38, 0.2, 1.0),
    "sand": (0.76, 0.68, 0.5, 1.0),
    "rock": (0.45, 0.44, 0.42, 1.0),
    "gravel": (0.5, 0.48, 0.45, 1.0),
    "asphalt": (0.25, 0.25, 0.26, 1.0),
    "snow": (0.92, 0.93, 0.95, 1.0),
}
SOIL: description.Rgba = (0.45, 0.4, 0.3, 1.0)


def read_heightmap(element: Element, source: Source, where: str) -> description.Heightmap:
    """Terrain; flat, with a warning, if its image cannot be used."""
    where = f"{where} <heightmap>"
    path = _image(element, source, where, "flat ground of its size is taken")
    return description.Heightmap(
        path=path,
        size=xml.vector(element, "size", description.Heightmap(None).size, where),
        position=xml.vector(element, "pos", description.Heightmap(None).position, where),
        layers=_layers(element, source, where),
    )


def read_polylines(geometry: Element, source: Source, where: str) -> description.Polyline:
    """All `<polyline>` of a `<geometry>` as one solid, with the height of the first.

    FormatError for an outline of fewer than three points.
    """
    where = f"{where} <polyline>"
    elements = geometry.findall("polyline")
    outlines = tuple(
        tuple(xml.bounded(xml.numbers(point.text or "", 2, f"{where} <point>"), f"{where} <point>")
              for point in element.findall("point"))
        for element in elements
    )
    if any(len(outline) < 3 for outline in outlines):
        raise FormatError(f"{where}: an outline needs three <point>s or more")
    return description.Polyline(outlines, xml.length(elements[0], "height", 1.0, where))


def read_image(element: Element, source: Source, where: str) -> description.ImageExtrusion | None:
    """A floor plan; None, with a warning, if the image cannot be used.

    FormatError for an impossible number.
    """
    where = f"{where} <image>"
    path = _image(element, source, where, "left out")
    if path is None:
        return None
    return description.ImageExtrusion(
        path=path,
        scale=xml.length(element, "scale", 1.0, where),
        threshold=xml.integer(element, "threshold", 200, where),
        height=xml.length(element, "height", 1.0, where),
    )


def _image(element: Element, source: Source, where: str, otherwise: str) -> str | None:
    """Path of the image named by `<uri>`."""
    uri = xml.child_text(element, "uri") or xml.child_text(element, "filename")
    try:
        path = source.resources.resolve(uri, source.folder)
        if not path.is_file():
            raise ResourceNotFound(f"image {uri!r}", [str(path)])
        if path.suffix.lower() not in IMAGE_KINDS:
            raise FormatError(f"{path.name} is of a kind that cannot be read; there are: "
                              f"{', '.join(IMAGE_KINDS)}")
    except (ResourceNotFound, FormatError) as error:
        source.warn_once(f"{where}: {error}; {otherwise}", about=f"{where} {uri}")
        return None
    return str(path)


def _layers(element: Element, source: Source, where: str) -> tuple[description.TerrainLayer, ...]:
    """Textures with the heights where they begin; blending into each other is replaced by an edge.
    """
    lowest = [0.0] + [xml.amount(blend, "min_height", 0.0, f"{where} <blend>")
                      for blend in element.findall("blend")]
    layers = []
    for number, texture in enumerate(element.findall("texture")):
        tile = xml.amount(texture, "size", 10.0, f"{where} <texture>")
        layers.append(description.TerrainLayer(
            material=_ground(xml.child_text(texture, "diffuse"), source),
            tile=tile or 10.0,
            lowest=lowest[min(number, len(lowest) - 1)],
        ))
    return tuple(layers)


def _ground(uri: str, source: Source) -> description.Material:
    try:
        path = source.resources.resolve(uri, source.folder)
        if path.is_file():
            return description.Material(texture=str(path))
    except ResourceNotFound:
        pass  # Gazebo's own textures are not here, only their colours
    name = Path(uri).name.lower()
    colour = next((rgba for word, rgba in GROUNDS.items() if word in name), None)
    if colour is None:
        source.warn_once(f"heightmap texture {uri!r} not found; brown ground is drawn")
    return description.Material(ambient=colour or SOIL, diffuse=colour or SOIL)
