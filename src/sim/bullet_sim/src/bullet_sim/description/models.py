"""Models: links and joints, plugins, models nested in them, and an actor's way."""

from dataclasses import dataclass, field

from bullet_sim.description.joints import JointDescription
from bullet_sim.description.links import LinkDescription
from bullet_sim.description.plugins import PluginDescription
from bullet_sim.pose import IDENTITY, Pose


@dataclass(frozen=True)
class Trajectory:
    """Where an actor walks, whatever is in its way: straight from waypoint to waypoint."""

    waypoints: tuple[tuple[float, Pose], ...]  # s since the start and pose in the world, in order
    loop: bool = True
    delay_start: float = 0.0  # s, before every round
    auto_start: bool = True


@dataclass(frozen=True)
class ModelDescription:
    """Links that joints hold together, and who drives and reads them."""

    name: str
    pose: Pose = IDENTITY  # in the world
    static: bool = False
    self_collide: bool = False
    auto_disables: bool = True  # <allow_auto_disable>: whether what hardly moves is held still
    links: tuple[LinkDescription, ...] = ()
    joints: tuple[JointDescription, ...] = ()
    plugins: tuple[PluginDescription, ...] = ()
    child_models: tuple[str, ...] = ()  # names of nested models; their links are named nested::link
    child_poses: dict[str, Pose] = field(default_factory=dict)  # of nested models in this one
    lumped: dict[str, tuple[str, Pose]] = field(default_factory=dict)
    # link that fixed-joint lumping took away -> (surviving link, pose in that link's frame)
    trajectory: Trajectory | None = None  # of an actor
