"""Robots, worlds and launch files with very many parts, deep ones, or ones that go in circles.

`LARGE` holds name, file name and text of each; those of launch files may also not end.
"""

from __future__ import annotations

from collections.abc import Callable

from spoilt_parts import BOTH, MANY, MODEL, NAMESPACE, ROBOT, WORLD, YAML_BOMB

LARGE: dict[str, tuple[str, str]] = {}


def add(name: str, file: str, text: str) -> None:
    """One more."""
    LARGE[name] = (file, text)


def _links(n: int, parent: Callable[[int], int]) -> str:
    inertia = ROBOT.partition("<inertial>")[2].partition("</inertial>")[0]
    links = "".join(f'<link name="l{i}"><inertial>{inertia}</inertial></link>' for i in range(n))
    joints = "".join(
        f'<joint name="j{i}" type="continuous"><parent link="l{parent(i)}"/>'
        f'<child link="l{i}"/></joint>' for i in range(1, n))
    return f'<robot name="r">{links}{joints}</robot>'


BOX = BOTH.format("<box><size>1 1 1</size></box>")
add("robot star", "a.urdf", _links(5000, lambda i: 0))
add("robot chain", "a.urdf", _links(5000, lambda i: i - 1))
add("robot tree", "a.urdf", _links(1000, lambda i: i // 2))
def _place(i: int) -> str:
    return f"<pose>{3 * (i % 50)} {3 * (i // 50)} 2 0 0 0</pose>"


# As many as the largest worlds have; the time grows with what there is to simulate.
add("world of models", "a.world", WORLD.format("".join(
    f'<model name="m{i}">{_place(i)}<link name="l">{BOX}</link></model>' for i in range(1000))))
add("model of links", "a.world", WORLD.format('<model name="m">' + "".join(
    f'<link name="l{i}">{_place(i)}{BOX}</link>' for i in range(500)) + "</model>"))
add("link of collisions", "a.world", WORLD.format(MODEL.format("".join(
    BOX.replace("'c'", f"'c{i}'").replace("'v'", f"'v{i}'") for i in range(3000)))))
add("world of lights", "a.world", WORLD.format("".join(
    f"<light name='l{i}' type='point'/>" for i in range(5000))))
add("sensors", "a.world", WORLD.format(MODEL.format("".join(
    f"<sensor name='s{i}' type='ray'><update_rate>1e9</update_rate><ray><scan><horizontal>"
    "<samples>4000000000</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>"
    "</scan><range><min>0</min><max>1e9</max></range></ray></sensor>" for i in range(100)))))
add("camera of a size", "a.world", WORLD.format(MODEL.format(
    "<sensor name='s' type='camera'><update_rate>30</update_rate><camera><image><width>4000000000"
    "</width><height>4000000000</height></image></camera><plugin name='p' "
    "filename='libgazebo_ros_camera.so'><cameraName>c</cameraName></plugin></sensor>")))
add("polyline", "a.world", WORLD.format(MODEL.format(BOTH.format(
    "<polyline>" + "<point>0 1</point><point>1 0</point>" * 50_000
    + "<height>1e9</height></polyline>"))))
add("population", "a.world", WORLD.format(
    f"<population name='p'>{MODEL.format(BOX)}<model_count>{MANY}</model_count>"
    "<distribution><type>grid</type><rows>99999</rows><cols>99999</cols></distribution>"
    "<box><size>1 1 1</size></box></population>"))
add("actor", "a.world", WORLD.format(
    "<actor name='a'><script><trajectory id='0' type='walk'>" + "".join(
        f"<waypoint><time>{i % 7}</time><pose>{i} 0 0 0 0 0</pose></waypoint>"
        for i in range(50_000)) + "</trajectory></script></actor>"))
add("road", "a.world", WORLD.format(
    "<road name='r'><width>1e9</width>" + "<point>0 0 0</point><point>1 1 1</point>" * 50_000
    + "</road>"))
add("state", "a.world", WORLD.format(MODEL.format(BOX) + "<state world_name='w'>" + "".join(
    f"<model name='m{i}'><pose>0 0 0 0 0 0</pose></model>" for i in range(20_000)) + "</state>"))
add("step size", "a.world", WORLD.format(
    "<physics type='ode'><max_step_size>1e-12</max_step_size><real_time_update_rate>1e12"
    "</real_time_update_rate><ode><solver><iters>4000000000</iters></solver></ode></physics>"))
add("macro in itself", "a.xacro", f'<robot name="r" {NAMESPACE}><xacro:macro name="m" params="a">'
    '<link name="${a}"/><xacro:m a="${a + a}"/></xacro:macro><xacro:m a="xx"/></robot>')
add("properties that double", "a.xacro", f'<robot name="r" {NAMESPACE}><xacro:property name="p0" '
    'value="xxxxxxxx"/>' + "".join(
         f'<xacro:property name="p{i}" value="${{p{i - 1} * 2}}"/>' for i in range(1, 60))
    + '<link name="${p59}"/></robot>')
add("attributes of one tag", "a.xacro", f'<robot name="r" {NAMESPACE}><a '
    + " ".join(f'a{i}="${{1}}"' for i in range(50_000)) + "/></robot>")
COMMAND = '<launch><param name="robot_description" command="{0}"/></launch>'
add("command that waits", "a.launch", COMMAND.format("sleep 1000"))
add("command that is not there", "a.launch", COMMAND.format("no_such_command x"))
add("command that fails", "a.launch", COMMAND.format("false"))
add("command that never ends its output", "a.launch", COMMAND.format("yes"))
add("command of bytes", "a.launch", COMMAND.format("head -c 100 /dev/urandom"))
add("nodes", "a.launch", "<launch>" + "".join(
    f'<node name="n{i}" pkg="gazebo_ros" type="spawn_model" args="-param p{i}"/>'
    for i in range(5000)) + "</launch>")
add("node that is not whole", "a.launch", "<launch><node name='a'/><param/><include/></launch>")
add("rosparam text", "a.launch", f"<launch><rosparam>{YAML_BOMB}</rosparam></launch>")
add("rosparam text open", "a.launch", "<launch><rosparam>a: [1, {</rosparam></launch>")
add("arguments in a circle", "a.launch", '<launch><arg name="a" value="$(arg b)"/>'
    '<arg name="b" value="$(arg a)"/></launch>')
add("machine and remap", "a.launch", '<launch><machine name="m" address="no.such" /><remap '
    'from="" to=""/><group ns="/ /"><node name="/a b" pkg="" type=""/></group></launch>')
