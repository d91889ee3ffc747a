"""Small robots for the tests of what moves things, as SDF text."""

from types import SimpleNamespace

import pytest
from geometry_msgs.msg import Twist

WHEEL_RADIUS = 0.1  # m


def link(name: str, pose: str, shape: str, mass: float = 1.0, mu: float = 1.0,
         extra: str = "") -> str:
    """A link with one collision."""
    return f"""<link name="{name}"><pose>{pose}</pose>{extra}
      <inertial><mass>{mass}</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz>
        <ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>
      <collision name="c"><geometry>{shape}</geometry><surface><friction><ode>
        <mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface></collision></link>"""


def box(x: float, y: float, z: float) -> str:
    """A shape; full lengths in m."""
    return f"<box><size>{x} {y} {z}</size></box>"


def wheel(name: str, x: float, y: float) -> str:
    """A link that stands on the ground and turns about the model's y axis by NAME_joint."""
    shape = f"<cylinder><radius>{WHEEL_RADIUS}</radius><length>0.04</length></cylinder>"
    return link(name, f"{x} {y} {WHEEL_RADIUS} -1.5707963 0 0", shape) + revolute(
        f"{name}_joint", "base", name, "0 0 1")


def revolute(name: str, parent: str, child: str, axis: str, kind: str = "revolute",
             limits: str = "") -> str:
    """A joint about an axis of the child's frame."""
    return f"""<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>
      <axis><xyz>{axis}</xyz>{limits}</axis></joint>"""


def plugin(filename: str, **tags) -> str:
    """A plugin element."""
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return f'<plugin name="p" filename="{filename}">{inner}</plugin>'


def base(z: float = WHEEL_RADIUS) -> str:
    """The chassis."""
    return link("base", f"0 0 {z} 0 0 0", box(0.3, 0.2, 0.06), mass=5.0)


def two_wheels(*plugins: str, name: str = "car", left: str = "left", right: str = "right") -> str:
    """Two driven wheels 0.4 m apart and two balls that slide; the model frame is on the ground."""
    balls = "".join(
        link(f"ball{x}", f"{x} 0 0.03 0 0 0", "<sphere><radius>0.03</radius></sphere>", 0.2, 0.0)
        + revolute(f"ball{x}_joint", "base", f"ball{x}", "0 0 1", "fixed") for x in (0.12, -0.12))
    return (f'<model name="{name}"><link name="foot"><inertial><mass>0.1</mass></inertial></link>'
            + revolute("foot_joint", "foot", "base", "0 0 1", "fixed") + base()
            + wheel(left, 0.0, 0.2) + wheel(right, 0.0, -0.2) + balls + "".join(plugins)
            + "</model>")


def four_wheels(*plugins: str) -> str:
    """Wheels 0.4 m apart, axles 0.3 m apart."""
    wheels = "".join(wheel(f"{side}_{place}", x, y) for side, y in (("left", 0.2), ("right", -0.2))
                     for place, x in (("front", 0.15), ("rear", -0.15)))
    return f'<model name="car">{base()}{wheels}{"".join(plugins)}</model>'


def three_wheels(*plugins: str) -> str:
    """A steered and driven front wheel, 0.5 m before two that roll 0.4 m apart."""
    fork = link("fork", "0.25 0 0.25 0 0 0", box(0.03, 0.03, 0.03), 0.5)
    front = link("front", f"0.25 0 {WHEEL_RADIUS} -1.5707963 0 0", "<cylinder><radius>"
                 f"{WHEEL_RADIUS}</radius><length>0.04</length></cylinder>")
    joints = revolute("front_steering_joint", "base", "fork", "0 0 1") + revolute(
        "front_wheel_joint", "fork", "front", "0 0 1")
    rear = "".join(wheel(f"{side}_wheel", -0.25, y) for side, y in (("left", 0.2),
                                                                   ("right", -0.2)))
    return f'<model name="car">{base()}{fork}{front}{joints}{rear}{"".join(plugins)}</model>'


def cube(name: str, *plugins: str, mass: float = 1.0, mu: float = 0.0, size: float = 0.2) -> str:
    """A lone cube whose frame is in its middle."""
    return (f'<model name="{name}">'
            + link("body", "0 0 0 0 0 0", box(size, size, size), mass, mu)
            + f'{"".join(plugins)}</model>')


def command(x: float = 0.0, y: float = 0.0, turn: float = 0.0) -> Twist:
    """Forward and leftward in m/s, turn in rad/s (or the steering angle in rad)."""
    msg = Twist()
    msg.linear.x, msg.linear.y, msg.angular.z = x, y, turn
    return msg


@pytest.fixture(scope="session")
def robots() -> SimpleNamespace:
    """All of the above, by name."""
    return SimpleNamespace(link=link, box=box, plugin=plugin, two_wheels=two_wheels, cube=cube,
                           four_wheels=four_wheels, three_wheels=three_wheels, wheel=wheel,
                           revolute=revolute, base=base, command=command)
