"""The content of model and world files as plain data: no mesh is opened, no physics is imported.

All lengths in m, angles in rad, masses in kg. Link poses are in the model frame with every joint at
zero. This is the package's face: others import from here, not from the files by subject.
"""

from bullet_sim.description.joints import JointDescription, SecondAxis
from bullet_sim.description.links import Collision, Inertial, LinkDescription, Visual
from bullet_sim.description.models import ModelDescription, Trajectory
from bullet_sim.description.plugins import PluginDescription
from bullet_sim.description.scenes import Fog, LightDescription, SceneDescription
from bullet_sim.description.sensors import (
    CameraDescription,
    ImuDescription,
    Lens,
    Noise,
    RayDescription,
    SensorDescription,
)
from bullet_sim.description.shapes import (
    Box,
    Cylinder,
    Generated,
    Geometry,
    Heightmap,
    ImageExtrusion,
    Mesh,
    Plane,
    Polyline,
    Sphere,
    Strip,
    TerrainLayer,
)
from bullet_sim.description.surfaces import Material, Rgba, Surface
from bullet_sim.description.worlds import PhysicsDescription, SphericalDescription, WorldDescription

__all__ = [
    "Box",
    "CameraDescription",
    "Collision",
    "Cylinder",
    "Fog",
    "Generated",
    "Geometry",
    "Heightmap",
    "ImageExtrusion",
    "ImuDescription",
    "Inertial",
    "JointDescription",
    "Lens",
    "LightDescription",
    "LinkDescription",
    "Material",
    "Mesh",
    "ModelDescription",
    "Noise",
    "PhysicsDescription",
    "Plane",
    "PluginDescription",
    "Polyline",
    "RayDescription",
    "Rgba",
    "SceneDescription",
    "SecondAxis",
    "SensorDescription",
    "Sphere",
    "SphericalDescription",
    "Strip",
    "Surface",
    "TerrainLayer",
    "Trajectory",
    "Visual",
    "WorldDescription",
]
