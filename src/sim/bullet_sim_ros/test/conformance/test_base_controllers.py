"""Bases under ros_control whose commands become those of several wheels: steer bots, mecanum."""

from __future__ import annotations

import math
import threading
import time

import pytest
from geometry_msgs.msg import Twist, Vector3

from bullet_sim.pose import Pose
from bullet_sim_ros.control.controllers import mobile_bases
from bullet_sim_ros.without_master import Graph

LIMIT = 60.0  # s, wall, for controllers to start
COVARIANCE = [0.001, 0.001, 1e6, 1e6, 1e6, 0.03]
TRANSMISSION = """<transmission name="{0}"><type>transmission_interface/SimpleTransmission</type>
  <joint name="{0}"><hardwareInterface>hardware_interface/{1}JointInterface</hardwareInterface>
  </joint><actuator name="{0}"/></transmission>"""


def link(name: str, mass: float, size: float, shape: str) -> str:
    inertia = mass * size * size
    return f"""<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{inertia}" ixy="0"
        ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial>{shape}</link>"""


def joint(name: str, parent: str, child: str, xyz, axis, kind="continuous", limit="") -> str:
    place, turn = " ".join(map(str, xyz)), " ".join(map(str, axis))
    return f"""<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
        <origin xyz="{place}"/><axis xyz="{turn}"/>{limit}</joint>"""


def wheel(name: str, parent: str, xyz, driven: str = "") -> str:
    shape = """<collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.1"
        length="0.04"/></geometry></collision>"""
    return (link(f"{name}_link", 0.5, 0.07, shape) + joint(
        name, parent, f"{name}_link", xyz, (0, 1, 0),
        limit='<limit effort="20" velocity="50"/>')
        + (TRANSMISSION.format(name, driven) if driven else ""))


def body(size: str = "0.5 0.3 0.06", mass: float = 8.0) -> str:
    return link("base_link", mass, 0.2, f'<collision><geometry><box size="{size}"/></geometry>'
                "</collision>")


def robot(parts: str, simulation_type: str = "") -> str:
    kind = f"<robotSimType>{simulation_type}</robotSimType>" if simulation_type else ""
    return f"""<robot name="r">{parts}<gazebo><plugin name="p" filename="libgazebo_ros_control.so">
        {kind}</plugin></gazebo></robot>"""


def run(bench, graph: Graph, *names: str, meanwhile=lambda: None) -> None:
    """Load and start controllers, as a spawner does; time passes, and `meanwhile` is called
    between the two.
    """
    answers = []

    def ask(service: str, **fields) -> None:
        kind, handler = graph.services[f"/r/controller_manager/{service}"]
        answers.append(handler(kind._request_class(**fields)).ok)

    def work() -> None:
        for name in names:
            ask("load_controller", name=name)
        meanwhile()
        ask("switch_controller", start_controllers=names, strictness=2, timeout=LIMIT)

    client = threading.Thread(target=work, daemon=True)
    client.start()
    while client.is_alive():
        bench.run_steps(1)
        client.join(0.001)
    assert all(answers) and answers


def drive(bench, seconds: float, x: float = 0.0, y: float = 0.0, turn: float = 0.0) -> None:
    for _ in range(round(seconds / 0.1)):
        bench.send("/r/drive/cmd_vel", Twist(Vector3(x, y, 0), Vector3(0, 0, turn)))
        bench.run(0.1)


def configure(graph: Graph, name: str, **values) -> None:
    graph.parameters.update({f"/r/{name}/{key}": value for key, value in values.items()})


# --- steer bots

STEER_BOT = "steer_bot_hardware_gazebo"
TRACK, WHEELBASE = 0.4, 0.6


def steer_bot() -> str:
    """A car with two rear wheels and two steered front wheels, as its author draws it."""
    parts = body()
    for side, y in (("right", -TRACK / 2), ("left", TRACK / 2)):
        parts += wheel(f"rear_{side}", "base_link", (-WHEELBASE / 2, y, 0))
        parts += link(f"{side}_hinge", 0.3, 0.05, "") + joint(
            f"{side}_steer", "base_link", f"{side}_hinge", (WHEELBASE / 2, y, 0), (0, 0, 1),
            "revolute", '<limit lower="-0.8" upper="0.8" effort="20" velocity="10"/>')
        parts += wheel(f"front_{side}", f"{side}_hinge", (0, 0, 0))
    return robot(parts, f"{STEER_BOT}/SteerBotHardwareGazebo")


@pytest.fixture
def car(bench, graph):
    """`car(**parameters)`: a steer bot with upstream's parameters, driven and spoken of."""
    def make(kind: str = "ackermann_steering_controller/AckermannSteeringController", **more):
        configure(graph, STEER_BOT, rear_wheel="virtual_rear", front_steer="virtual_steer",
                  virtual_rear_wheels=["rear_right", "rear_left"],
                  virtual_front_wheels=["front_right", "front_left"],
                  virtual_front_steers=["right_steer", "left_steer"], **more)
        configure(graph, "drive", type=kind, rear_wheel="virtual_rear",
                  front_steer="virtual_steer", wheel_separation_h=WHEELBASE, wheel_radius=0.1,
                  pose_covariance_diagonal=COVARIANCE, twist_covariance_diagonal=COVARIANCE)
        configure(graph, "states", type="joint_state_controller/JointStateController",
                  publish_rate=50)
        graph.parameters["/robot_description"] = steer_bot()
        model = bench.spawn(steer_bot(), Pose((0, 0, 0.1)))
        bench.run(0.1)
        run(bench, graph, "drive", "states")
        return model
    return make


@pytest.mark.parametrize("kind", ["ackermann_steering_controller/AckermannSteeringController",
                                  "steer_drive_controller/SteerDriveController"])
def test_a_steer_bot_drives_the_circle_of_its_virtual_joint(bench, car, kind):
    # conforms: libgazebo_ros_control.so/robotSimType
    # conforms: controllers/steer_drive_controller/SteerDriveController
    # conforms: controllers/ackermann_steering_controller/AckermannSteeringController
    model = car(kind)
    odometry, states = bench.listen("/r/drive/odom"), bench.listen("/r/joint_states")
    drive(bench, 2.0, 0.5, turn=0.3)
    radius = WHEELBASE / math.tan(0.3)
    right, left = (math.atan(WHEELBASE / (radius + side * TRACK / 2)) for side in (1, -1))
    assert model.joint("right_steer").position == pytest.approx(right, abs=0.01)
    assert model.joint("left_steer").position == pytest.approx(left, abs=0.01)
    rates = [model.joint(f"rear_{side}").velocity for side in ("right", "left")]
    assert rates == pytest.approx([5.0 * (1 + side * TRACK / 2 / radius) for side in (1, -1)],
                                  abs=0.2)
    assert model.twist.angular[2] == pytest.approx(0.5 / radius, rel=0.05)
    last = odometry[-1].twist.twist
    assert last.linear.x == pytest.approx(0.5, abs=0.02)
    assert last.angular.z == pytest.approx(0.5 / radius, rel=0.03)
    spoken = dict(zip(states[-1].name, states[-1].position, strict=True))
    assert spoken["virtual_steer"] == pytest.approx(0.3, abs=0.01)
    assert {"virtual_rear", "rear_left", "left_steer"} <= set(spoken)


def test_a_steer_bot_of_parallel_links(bench, car):
    # conforms: libgazebo_ros_control.so/robotSimType
    model = car(enable_ackermann_link=False, wheel_separation_w=TRACK,
                wheel_separation_h=WHEELBASE)
    drive(bench, 0.5, 0.2, turn=0.3)
    for name in ("right_steer", "left_steer"):
        assert model.joint(name).position == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("change, told", [
    ({"virtual_rear_wheels": ["rear_left"]}, "virtual_rear_wheels has 1 joints; there must be two"),
    ({"front_steer": None}, "/r/steer_bot_hardware_gazebo/front_steer is not set"),
    ({"virtual_front_steers": ["a", "b"]}, "'a'")])
def test_a_steer_bot_that_cannot_be(bench, graph, caplog, change, told):
    # conforms: libgazebo_ros_control.so/robotSimType
    configure(graph, STEER_BOT, **{"rear_wheel": "w", "front_steer": "s",
              "virtual_rear_wheels": ["rear_right", "rear_left"],
              "virtual_front_steers": ["right_steer", "left_steer"], **change})
    graph.parameters = {name: value for name, value in graph.parameters.items()
                        if value is not None}
    graph.parameters["/robot_description"] = steer_bot()
    bench.spawn(steer_bot(), Pose((0, 0, 0.1)))
    assert told in caplog.text


# --- mecanum

HALF_LENGTH, HALF_WIDTH = 0.2, 0.18
RIM, BALL, BALLS = 0.03, 0.07, 8  # m, m, a wheel; together a wheel of 0.1 m


def mecanum_wheel(name: str, x: float, y: float) -> str:
    """Balls for rollers; their axes stand at 45 degrees to the axle."""
    slant = 1 if x * y > 0 else -1
    parts = link(f"{name}_hub", 0.4, 0.07, "") + joint(
        name, "base_link", f"{name}_hub", (x, y, 0), (0, 1, 0),
        limit='<limit effort="20" velocity="50"/>') + TRANSMISSION.format(name, "Velocity")
    shape = f'<collision><geometry><sphere radius="{BALL}"/></geometry></collision>'
    for number in range(BALLS):
        angle = math.tau * number / BALLS
        out, along = (math.sin(angle), math.cos(angle)), (math.cos(angle), -math.sin(angle))
        half = math.sqrt(0.5)
        parts += link(f"{name}_ball{number}", 0.05, 0.04, shape) + joint(
            f"{name}_roller{number}", f"{name}_hub", f"{name}_ball{number}",
            (RIM * out[0], 0, RIM * out[1]),
            (slant * half * along[0], half, slant * half * along[1]))
        parts += f'<gazebo reference="{name}_ball{number}"><mu1>1</mu1><mu2>1</mu2></gazebo>'
    return parts


CORNERS = {"front_left": (1, 1), "back_left": (-1, 1), "back_right": (-1, -1),
           "front_right": (1, -1)}


def mecanum(make=mecanum_wheel) -> str:
    return robot(body() + "".join(make(corner, x * HALF_LENGTH, y * HALF_WIDTH)
                                  for corner, (x, y) in CORNERS.items()))


def plain_wheel(name: str, x: float, y: float) -> str:
    return wheel(name, "base_link", (x, y, 0), "Velocity")


def start_mecanum(bench, graph, text: str, meanwhile=lambda: None, **more):
    configure(graph, "drive", type="mecanum_drive_controller/MecanumDriveController",
              pose_covariance_diagonal=COVARIANCE, twist_covariance_diagonal=COVARIANCE,
              **{f"{corner}_wheel_joint": corner for corner in CORNERS}, **more)
    graph.parameters["/robot_description"] = text
    model = bench.spawn(text, Pose((0, 0, 0.1)))
    bench.run(0.1)
    run(bench, graph, "drive", meanwhile=meanwhile)
    return model


def test_a_driver_may_come_before_the_spawner_is_done(bench, graph, caplog, monkeypatch):
    # conforms: controllers/mecanum_drive_controller/MecanumDriveController
    monkeypatch.setattr(mobile_bases, "STARTING", 0.2)
    command, refusal = Twist(Vector3(0.3, 0, 0), Vector3()), "Controller is not running"

    def drive_already():
        bench.send("/r/drive/cmd_vel", command)
        said.append(refusal in caplog.text)
        waiting = bench.world.time + 0.3
        while bench.world.time <= waiting:
            time.sleep(0.01)
        bench.send("/r/drive/cmd_vel", command)

    said = []
    start_mecanum(bench, graph, mecanum(plain_wheel), drive_already)
    assert said == [False] and caplog.text.count(refusal) == 1


@pytest.mark.parametrize("x, y, turn", [(0.3, 0, 0), (0, 0.3, 0), (0, 0, 0.6), (0.2, -0.2, 0)])
def test_wheels_with_rollers_go_everywhere(bench, graph, caplog, x, y, turn):
    # conforms: controllers/mecanum_drive_controller/MecanumDriveController
    model = start_mecanum(bench, graph, mecanum(), wheel_radius=RIM + BALL)
    assert "no rollers" not in caplog.text
    odometry = bench.listen("/r/drive/odom")
    drive(bench, 1.0, x, y, turn)
    before, yaw = model.pose.position, model.pose.rpy()[2]
    drive(bench, 1.0, x, y, turn)
    way = [now - then for now, then in zip(model.pose.position, before, strict=True)]
    middle = (yaw + model.pose.rpy()[2]) / 2
    forward = way[0] * math.cos(middle) + way[1] * math.sin(middle)
    leftward = way[1] * math.cos(middle) - way[0] * math.sin(middle)
    assert (forward, leftward) == pytest.approx((x, y), abs=0.06)
    assert model.pose.rpy()[2] - yaw == pytest.approx(turn, abs=0.1)
    last = odometry[-1].twist.twist
    assert (last.linear.x, last.linear.y, last.angular.z) == pytest.approx((x, y, turn), abs=0.03)


def test_plain_wheels_drive_and_say_what_they_cannot(bench, graph, caplog):
    # conforms: controllers/mecanum_drive_controller/MecanumDriveController
    model = start_mecanum(bench, graph, mecanum(plain_wheel),
                          **{"linear/y/has_velocity_limits": True, "linear/y/max_velocity": 0.1})
    assert "controller /r/drive: its wheels have no rollers" in caplog.text
    drive(bench, 1.0, 0.3)
    assert model.twist.linear[0] == pytest.approx(0.3, abs=0.03)
    bench.run(1.0)  # nobody speaks any more
    assert model.twist.linear[0] == pytest.approx(0.0, abs=0.02)
    drive(bench, 0.3, y=0.5)
    assert model.joint("front_right").velocity == pytest.approx(1.0, abs=0.1)  # limited, 0.1 m
    assert model.joint("front_left").velocity == pytest.approx(-1.0, abs=0.1)
