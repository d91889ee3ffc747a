"""Reading URDF, SDF, xacro and OGRE material files into `bullet_sim.description`."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bullet_sim.formats.loading import load_light, load_model, load_world
    from bullet_sim.formats.resources import Resources

__all__ = ["Resources", "load_light", "load_model", "load_world"]


def __getattr__(name: str):
    # Imported at first use: the xacro command does not need it, and importing NumPy is slow.
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = "resources" if name == "Resources" else "loading"
    return getattr(import_module(f"{__name__}.{home}"), name)
