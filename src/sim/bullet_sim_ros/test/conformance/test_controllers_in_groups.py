"""Controllers of several joints, and of one joint's position by its speed."""

from __future__ import annotations

import threading

import pytest
from std_msgs.msg import Float64, Float64MultiArray

from bullet_sim_ros.without_master import Graph

LIMIT = 60.0  # s, wall, for a controller to start
INERTIAL = """<inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0"
    izz="0.1"/></inertial>"""
JOINT = """<link name="{0}"/><joint name="{0}" type="revolute"><parent link="base"/>
    <child link="{0}"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="20" velocity="10"/></joint>
    <transmission name="{0}"><type>transmission_interface/SimpleTransmission</type>
    <joint name="{0}"><hardwareInterface>hardware_interface/{1}JointInterface</hardwareInterface>
    </joint><actuator name="{0}"/></transmission>"""
POSITION, VELOCITY = "position", "velocity"


def robot(interface: str) -> str:
    """Two joints on one base, about vertical axes."""
    joints = "".join(JOINT.format(name, interface) for name in ("a", "b"))
    return f"""<robot name="r"><link name="world"/><link name="base">{INERTIAL}</link>
        <joint name="foot" type="fixed"><parent link="world"/><child link="base"/></joint>
        {joints.replace('"/><joint', f'">{INERTIAL}</link><joint')}
        <gazebo><plugin name="p" filename="libgazebo_ros_control.so"/></gazebo></robot>"""


def start(bench, graph: Graph) -> None:
    """As spawner does; time passes meanwhile, for a switch waits for an update."""
    answers = []

    def ask(service: str, **fields) -> None:
        kind, handler = graph.services[f"/r/controller_manager/{service}"]
        answers.append(handler(kind._request_class(**fields)).ok)

    def work() -> None:
        ask("load_controller", name="moved")
        ask("switch_controller", start_controllers=["moved"], strictness=2, timeout=LIMIT)

    client = threading.Thread(target=work, daemon=True)
    client.start()
    while client.is_alive():
        bench.run_steps(1)
        client.join(0.001)
    assert answers == [True, True]


@pytest.mark.parametrize("kind, interface, parameters, told, quantity", [
    ("velocity_controllers/JointGroupVelocityController", "Velocity", {}, [0.5, -0.25], VELOCITY),
    ("position_controllers/JointGroupPositionController", "Position", {}, [0.5, -0.25], POSITION),
    ("effort_controllers/JointGroupPositionController", "Effort",
     {f"{joint}/pid/{gain}": value for joint in "ab" for gain, value in (("p", 40.0), ("d", 5.0))},
     [0.5, -0.25], POSITION),
    ("velocity_controllers/JointPositionController", "Velocity", {"joint": "a", "pid/p": 5.0},
     [0.5], POSITION)])
def test_it_takes_its_joints_where_it_is_told(bench, graph, kind, interface, parameters, told,
                                              quantity):
    # conforms: controllers/velocity_controllers/JointGroupVelocityController
    # conforms: controllers/position_controllers/JointGroupPositionController
    # conforms: controllers/effort_controllers/JointGroupPositionController
    # conforms: controllers/velocity_controllers/JointPositionController
    text = robot(interface)
    values = {"type": kind, "joints": ["a", "b"], **parameters}
    graph.parameters.update({f"/r/moved/{name}": value for name, value in values.items()})
    graph.parameters["/robot_description"] = text
    model = bench.spawn(text)
    start(bench, graph)
    message = Float64(told[0]) if len(told) == 1 else Float64MultiArray(data=told)
    bench.send("/r/moved/command", message)
    bench.run(1.5)
    reached = [getattr(model.joint(name), quantity) for name in ("a", "b")]
    assert reached == pytest.approx([*told, 0.0][:2], abs=0.02)
