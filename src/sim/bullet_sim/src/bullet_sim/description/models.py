"""Models: links and joints, plugins, nested models, and an actor's trajectory."""

from dataclasses import dataclass, field

from bullet_sim.description.joints import JointDescription
from bullet_sim.description.links import LinkDescription
from bullet_sim.description.plugins import PluginDescription
from bullet_sim.pose import IDENTITY, Pose


@dataclass(frozen=True)
class Trajectory:
    """The way of an actor, regardless of obstacles: straight between waypoints."""

    waypoints: tuple[tuple[float, Pose], ...]  # s since the start and pose in the world, in order
    loop: bool = True
    delay_start: float = 0.0  # s, before every round
    auto_start: bool = True


@dataclass(frozen=True)
class ModelDescription:
    """Links connected by joints, with the plugins that drive and read them."""

    name: str
    pose: Pose = IDENTITY  # in the world
    static: bool = False
    self_collide: bool = False
    auto_disables: bool = True  # <allow_auto_disable>: links that hardly move are held still
    links: tuple[LinkDescription, ...] = ()
    joints: tuple[JointDescription, ...] = ()
    plugins: tuple[PluginDescription, ...] = ()
    child_models: tuple[str, ...] = ()  # names of nested models; their links are named nested::link
    child_poses: dict[str, Pose] = field(default_factory=dict)  # of nested models in this one
    lumped: dict[str, tuple[str, Pose]] = field(default_factory=dict)
    # link removed by fixed-joint lumping -> (surviving link, pose in that link's frame)
    trajectory: Trajectory | None = None  # of an actor
