"""Puts one of the styles on a bench: a robot, a model folder, a world or a launch file."""

from __future__ import annotations

import argparse
import math
import threading
from dataclasses import dataclass, field
from pathlib import Path

import roslaunch.config
import roslib.message
import yaml
from genpy.message import fill_message_args
from geometry_msgs.msg import Point, Pose, Quaternion

from bullet_sim.description import Box, Cylinder, Plane, Sphere
from bullet_sim.formats.xacro.files import expand
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.model import Model
from bullet_sim.pose import Pose as Placement
from bullet_sim.pose import quaternion_from_rpy, rotation_matrix

FOLDER = Path(__file__).resolve().parents[2] / "styles"
LIMIT = 60.0  # s, wall, for controllers to start
STRICT = 2  # of controller_manager_msgs/SwitchController


@dataclass(frozen=True)
class Style:
    """One entry of expected.yaml; all but `file` and `models` may be absent.

    `models` says of each model which links and joints it has; `topics` has type, rate (Hz) and
    frame of each topic, of /tf as "parent -> child"; `send` is published after the five seconds,
    and `seconds` later `reaches` holds within `within`: joints are `model/joint` (rad or m), models
    have x, y and yaw. `warnings` are regular expressions, one for each line that is said, and
    `missing` the tags whose default the plugins of upstream's helper class announce.
    """

    file: str
    models: dict[str, dict | None]
    args: dict[str, str] = field(default_factory=dict)  # of xacro or roslaunch
    pose: tuple[float, ...] = (0, 0, 0, 0, 0, 0)  # m and rad
    namespace: str = "/"
    parameters: str = ""  # a file beside, loaded into the namespace
    controllers: tuple[str, ...] = ()
    topics: dict[str, tuple] = field(default_factory=dict)
    reads: dict[str, dict] = field(default_factory=dict)  # topic: path in its last message: value
    floor: float | None = 0.0  # m; None: there is none to stand on
    send: dict[str, tuple] = field(default_factory=dict)  # topic: type, fields
    seconds: float = 2.0
    reaches: dict[str, float | list[float]] = field(default_factory=dict)
    within: float = 0.05
    warnings: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()


def read_styles() -> dict[str, Style]:
    """All of expected.yaml by name."""
    entries = yaml.safe_load((FOLDER / "expected.yaml").read_text(encoding="utf-8"))
    return {name: Style(**entry) for name, entry in entries.items()}


class Stage:
    """A bench with a style on it, set up as roslaunch, spawn_model and spawner would."""

    def __init__(self, make_bench, graph, style: Style):
        self.graph, self.style = graph, style
        self._make_bench = make_bench
        path = FOLDER / style.file
        if path.suffix == ".launch":
            self._launch(path)
        elif path.suffix == ".world":
            self.bench = make_bench(path.read_text(encoding="utf-8"))
        else:
            self.bench = make_bench()
            self._robot(path)

    def _robot(self, path: Path) -> None:
        style = self.style
        if style.parameters:
            self.set_parameters(style.namespace, yaml.safe_load(
                (FOLDER / style.parameters).read_text(encoding="utf-8")))
        is_urdf = path.suffix in (".xacro", ".urdf")
        if path.is_dir():
            text = (f'<sdf version="1.4"><world name="default"><include><uri>model://{path.name}'
                    "</uri></include></world></sdf>")
        elif is_urdf:
            arguments = {name: str(value) for name, value in style.args.items()}
            text = expand(path, arguments, self.bench.resources.package_folder)
            self.set_parameters(style.namespace, {"robot_description": text})
        else:
            text = path.read_text(encoding="utf-8")
        (name,) = style.models
        self.spawn(name, text, is_urdf, pose_of(style.pose), style.namespace)
        self.start_controllers(style.namespace, style.controllers)

    def _launch(self, path: Path) -> None:
        """What its nodes do, in order: server, spawn_model and spawner; others are left out."""
        arguments = [f"{name}:={value}" for name, value in self.style.args.items()]
        config = roslaunch.config.load_config_default(
            [(str(path), arguments)], None, verbose=False, assign_machines=False)
        for name, parameter in config.params.items():
            self.graph.parameters[name] = parameter.value
        kinds = {kind: [node for node in config.nodes if node.type == kind]
                 for kind in ("gzserver", "spawn_model", "spawner")}
        (server,) = kinds["gzserver"]
        self._serve(server.args.split())
        for node in kinds["spawn_model"]:
            self._spawn_as_told(node.args.split(), node.namespace)
        for node in kinds["spawner"]:
            words = dict(word.partition("=")[::2] for word in node.args.split())
            namespace = words.pop("--namespace", node.namespace)
            self.start_controllers(namespace, [word for word in words if word[:2] != "--"])

    def _serve(self, words: list[str]) -> None:
        text = Path(words[-1]).read_text(encoding="utf-8")
        self.bench = self._make_bench(text)
        if "-u" in words:
            self.bench.call("/gazebo/pause_physics")

    def _spawn_as_told(self, words: list[str], namespace: str) -> None:
        parser = argparse.ArgumentParser()
        for flag in ("-urdf", "-sdf", "-unpause"):
            parser.add_argument(flag, action="store_true")
        for flag in ("-param", "-file", "-model"):
            parser.add_argument(flag)
        parser.add_argument("-robot_namespace", default=namespace)
        parser.add_argument("-J", nargs=2, action="append", default=[])
        for flag in ("-x", "-y", "-z", "-R", "-P", "-Y"):
            parser.add_argument(flag, type=float, default=0.0)
        told = parser.parse_args(words)
        text = Path(told.file).read_text(encoding="utf-8") if told.file else \
            self.graph.get_param(absolute(namespace, told.param))
        pose = pose_of((told.x, told.y, told.z, told.R, told.P, told.Y))
        self.spawn(told.model, text, told.urdf, pose, told.robot_namespace)
        if told.J:
            self.bench.call(
                "/gazebo/set_model_configuration", model_name=told.model,
                joint_names=[name for name, _ in told.J],
                joint_positions=[float(position) for _, position in told.J])
        if told.unpause:
            self.bench.call("/gazebo/unpause_physics")

    # --- single steps

    def set_parameters(self, namespace: str, tree: dict) -> None:
        """As `<rosparam>` does."""
        for key, value in tree.items():
            if isinstance(value, dict):
                self.set_parameters(absolute(namespace, key), value)
            else:
                self.graph.parameters[absolute(namespace, key)] = value

    def spawn(self, name: str, text: str, is_urdf: bool, pose: Pose, namespace: str) -> None:
        """As spawn_model does."""
        answer = self.bench.call(
            f"/gazebo/spawn_{'urdf' if is_urdf else 'sdf'}_model", model_name=name, model_xml=text,
            robot_namespace=namespace, initial_pose=pose)
        assert answer.success, answer.status_message

    def start_controllers(self, namespace: str, controllers) -> None:
        """As spawner does; time passes meanwhile, for a switch needs an update."""
        if not controllers:
            return
        manager = absolute(namespace, "controller_manager")
        answers = []

        def ask(service: str, **fields) -> None:
            kind, handler = self.graph.services[f"{manager}/{service}"]
            answers.append(handler(kind._request_class(**fields)).ok)

        def work() -> None:
            for name in controllers:
                ask("load_controller", name=name)
            ask("switch_controller", start_controllers=controllers, strictness=STRICT,
                timeout=LIMIT)

        client = threading.Thread(target=work, daemon=True)
        client.start()
        while client.is_alive():
            self.bench.run_steps(1)
            client.join(0.001)
        assert answers == [True] * (len(controllers) + 1), dict(zip(controllers, answers))

    def send(self) -> None:
        """Publish what the style says."""
        for topic, (kind, fields) in self.style.send.items():
            message = roslib.message.get_message_class(kind)()
            fill_message_args(message, [fields])
            self.bench.send(topic, message)


def absolute(namespace: str, name: str) -> str:
    """A name in a namespace, with one slash between them."""
    return name if name.startswith("/") else f"/{namespace.strip('/')}/{name}".replace("//", "/")


def pose_of(numbers) -> Pose:
    """x, y, z (m), roll, pitch, yaw (rad) as a message."""
    return Pose(Point(*numbers[:3]), Quaternion(*quaternion_from_rpy(*numbers[3:])))


def value_at(message, path: str):
    """What stands at a path such as `ranges.4` or `pose.pose.position.x`; `#` is a length."""
    for part in path.split("."):
        if part == "#":
            message = len(message)
        else:
            message = message[int(part)] if part.lstrip("-").isdigit() else getattr(message, part)
    return message


def lowest_point(model: Model) -> float:
    """Height of the lowest point of its collisions (m); without any, of its links' origins."""
    origins = [link.pose.position[2] for link in model.links.values()]
    return min([_lowest(collision.geometry, link.pose * collision.pose)
                for link in model.links.values() for collision in link.description.collisions]
               or origins)


def _lowest(geometry, pose: Placement) -> float:
    down, z = rotation_matrix(pose.orientation)[2], pose.position[2]
    if isinstance(geometry, Plane):
        return math.inf
    if isinstance(geometry, Sphere):
        return z - geometry.radius
    if isinstance(geometry, Box):
        return z - sum(abs(a) * size / 2 for a, size in zip(down, geometry.size, strict=True))
    if isinstance(geometry, Cylinder):
        across = math.sqrt(max(0.0, 1.0 - down[2] ** 2))
        return z - abs(down[2]) * geometry.length / 2 - across * geometry.radius
    return z + (collision_mesh(geometry)[0] @ down).min()
