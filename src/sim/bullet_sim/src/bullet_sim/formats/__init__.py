"""Reading URDF, SDF, xacro and OGRE material files into `bullet_sim.description`."""

from bullet_sim.formats.loading import load_light, load_model, load_world
from bullet_sim.formats.resources import Resources

__all__ = ["Resources", "load_light", "load_model", "load_world"]
