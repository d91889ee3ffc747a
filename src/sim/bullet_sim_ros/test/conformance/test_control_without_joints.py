"""A controller manager of which robot_description holds no URDF: it starts, with no joints."""

import pytest

MODEL = """<model name="bot"><link name="a"/><plugin name="c" filename="libgazebo_ros_control.so">
    <robotNamespace>/bot</robotNamespace></plugin></model>"""
SDF = f'<sdf version="1.6">{MODEL}</sdf>'


@pytest.mark.parametrize("held, found", [(SDF, "a <sdf>"), ("", "nothing"), ("  \n", "nothing"),
                                         (7, "nothing")])
def test_the_manager_is_there(bench, graph, caplog, held, found):
    # conforms: libgazebo_ros_control.so/robotParam
    graph.parameters["/bot/robot_description"] = held
    bench.spawn(MODEL)
    bench.run(0.2)
    said = [record.message for record in caplog.records if record.levelname != "INFO"]
    assert said == [f"model bot: plugin c (libgazebo_ros_control.so): its parameter "
                    f"robot_description holds {found}, not a URDF's <robot>: the controller "
                    "manager starts, but there is no joint to control"]
    assert bench.call("/bot/controller_manager/list_controllers").controller == []
    graph.parameters["/bot/states/type"] = "joint_state_controller/JointStateController"
    graph.parameters["/bot/states/publish_rate"] = 50
    assert bench.call("/bot/controller_manager/load_controller", name="states").ok


def test_a_text_that_is_no_xml_is_an_error(bench, graph, caplog):
    # conforms: libgazebo_ros_control.so/robotParam
    graph.parameters["/bot/robot_description"] = "<robot"
    bench.spawn(MODEL)
    assert "Could not initialize robot simulation interface" in caplog.text
    assert "/bot/controller_manager/list_controllers" not in graph.services
