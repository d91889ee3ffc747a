"""The content of model and world files as plain data: no mesh is opened, no physics is imported.

All lengths in m, angles in rad, masses in kg. Link poses are in the model frame with every joint at
zero. This is the package's interface: others import from here, not from its modules.
"""

from bullet_sim.description.models import Collision as Collision
from bullet_sim.description.models import Inertial as Inertial
from bullet_sim.description.models import JointAxis as JointAxis
from bullet_sim.description.models import JointDescription as JointDescription
from bullet_sim.description.models import JointLimits as JointLimits
from bullet_sim.description.models import LinkDescription as LinkDescription
from bullet_sim.description.models import ModelDescription as ModelDescription
from bullet_sim.description.models import SoftLimits as SoftLimits
from bullet_sim.description.models import Trajectory as Trajectory
from bullet_sim.description.models import Visual as Visual
from bullet_sim.description.scenes import Fog as Fog
from bullet_sim.description.scenes import LightDescription as LightDescription
from bullet_sim.description.scenes import SceneDescription as SceneDescription
from bullet_sim.description.sensors import CAMERA_TYPES as CAMERA_TYPES
from bullet_sim.description.sensors import RAY_TYPES as RAY_TYPES
from bullet_sim.description.sensors import SENSOR_TYPES as SENSOR_TYPES
from bullet_sim.description.sensors import WIDE_ANGLE as WIDE_ANGLE
from bullet_sim.description.sensors import CameraDescription as CameraDescription
from bullet_sim.description.sensors import ImuDescription as ImuDescription
from bullet_sim.description.sensors import Lens as Lens
from bullet_sim.description.sensors import Noise as Noise
from bullet_sim.description.sensors import PluginDescription as PluginDescription
from bullet_sim.description.sensors import RayDescription as RayDescription
from bullet_sim.description.sensors import SensorDescription as SensorDescription
from bullet_sim.description.shapes import Box as Box
from bullet_sim.description.shapes import Cylinder as Cylinder
from bullet_sim.description.shapes import Generated as Generated
from bullet_sim.description.shapes import Geometry as Geometry
from bullet_sim.description.shapes import Heightmap as Heightmap
from bullet_sim.description.shapes import ImageExtrusion as ImageExtrusion
from bullet_sim.description.shapes import Material as Material
from bullet_sim.description.shapes import Mesh as Mesh
from bullet_sim.description.shapes import Plane as Plane
from bullet_sim.description.shapes import Polyline as Polyline
from bullet_sim.description.shapes import Rgba as Rgba
from bullet_sim.description.shapes import Sphere as Sphere
from bullet_sim.description.shapes import Strip as Strip
from bullet_sim.description.shapes import Surface as Surface
from bullet_sim.description.shapes import TerrainLayer as TerrainLayer
from bullet_sim.description.worlds import PhysicsDescription as PhysicsDescription
from bullet_sim.description.worlds import SphericalDescription as SphericalDescription
from bullet_sim.description.worlds import WorldDescription as WorldDescription
