"""URDF by Gazebo's rules: links, joints, `<gazebo>` tags, lumping, files that it names."""

from __future__ import annotations

import logging
import math

import pytest

from bullet_sim.description import Box, Cylinder, Sphere
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources

INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
BALL = '<{0}><geometry><sphere radius="0.1"/></geometry></{0}>'
SHAPES = BALL.format("visual") + BALL.format("collision")


def link(name, more="", mass=1):
    return f'<link name="{name}"><inertial><mass value="{mass}"/>{INERTIA}</inertial>{more}</link>'


def joint(name, parent, child, kind="fixed", more=""):
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f"{more}</joint>")


def gazebo(content, reference=""):
    about = f' reference="{reference}"' if reference else ""
    return f"<gazebo{about}>{content}</gazebo>"


def read(body, resources=None):
    return load_model(f'<robot name="r">{body}</robot>', resources or Resources())


def surface_of(tag):
    (part,) = read(link("a", SHAPES) + gazebo(tag, "a")).links[0].collisions
    return part.surface


def only_joint(kind, more="", extra=""):
    (found,) = read(link("a") + link("b") + joint("j", "a", "b", kind, more) + extra).joints
    return found


LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'
HINGE = '<axis xyz="0 0 1"/>' + LIMIT


# --- links

def test_links_and_their_shapes():
    # conforms: urdf link, urdf link/visual, urdf link/collision, urdf visual, urdf visual/origin
    # conforms: urdf visual/geometry, urdf collision, urdf collision/origin, urdf collision/geometry
    # conforms: urdf geometry, urdf geometry/box, urdf geometry/cylinder, urdf geometry/sphere
    part = '<origin xyz="1 2 3" rpy="0 0 1.5"/><geometry>{}</geometry>'
    shapes = ['<box size="1 2 3"/>', '<cylinder radius="1" length="2"/>', '<sphere radius="4"/>']
    more = "".join(f"<{tag}>{part.format(shape)}</{tag}>"
                   for shape in shapes for tag in ("visual", "collision"))
    (found,) = read(link("a", more)).links
    for things in (found.visuals, found.collisions):
        assert [thing.geometry for thing in things] == [
            Box((1, 2, 3)), Cylinder(1, 2), Sphere(4)]
        assert things[0].pose.position == pytest.approx((1, 2, 3))
        assert things[0].pose.rpy() == pytest.approx((0, 0, 1.5))


def test_shapes_get_sdformats_names():
    # conforms: URDF conversion/names of shapes
    named = '<collision name="own"><geometry><sphere radius="1"/></geometry></collision>'
    (found,) = read(link("a", SHAPES + BALL.format("visual") + named)).links
    assert [part.name for part in found.visuals] == ["a_visual", "a_visual_1"]
    first, own = found.collisions
    assert first.name == "a_collision" and "own_collision" in own.name


def test_a_capsule_is_a_tube_with_round_ends():
    # conforms: urdf geometry/capsule
    shape = '<capsule radius="0.1" length="0.6"/>'
    part = f'<collision><origin xyz="1 0 0" rpy="1.5707963 0 0"/><geometry>{shape}</geometry>' \
           "</collision>"
    tube, one, other = read(link("a", part)).links[0].collisions
    assert (tube.geometry, one.geometry, other.geometry) == (
        Cylinder(0.1, 0.6), Sphere(0.1), Sphere(0.1))
    assert tube.pose.position == pytest.approx((1, 0, 0))
    assert {round(end.pose.position[1], 3) for end in (one, other)} == {-0.3, 0.3}


def test_inertial():
    # conforms: urdf link/inertial, urdf inertial, urdf inertial/mass, urdf inertial/inertia
    # conforms: urdf inertial/origin
    text = """<link name="a"><inertial><origin xyz="1 0 0"/><mass value="5"/>
        <inertia ixx="1" ixy="0.1" ixz="0.2" iyy="2" iyz="0.3" izz="3"/></inertial></link>"""
    inertial = read(text).links[0].inertial
    assert (inertial.mass, inertial.pose.position) == (5, (1, 0, 0))
    assert inertial.inertia == (1, 0.1, 0.2, 2, 0.3, 3)


def test_links_without_mass_take_what_hangs_on_them_away(caplog):
    # conforms: URDF conversion/links without inertial
    model = read(link("a") + '<link name="b"/>' + link("c", mass=2)
                 + joint("ab", "a", "b", "continuous") + joint("bc", "b", "c", "continuous"))
    assert [found.name for found in model.links] == ["a"] and model.joints == ()
    assert "link 'b' has no <inertial> or no mass and is left out, with c" in caplog.text
    zero = read(link("a") + link("b", mass=0) + joint("ab", "a", "b", "continuous"))
    assert len(zero.links) == 1


def test_gazebos_colours_are_drawn_and_urdfs_are_not():
    # conforms: urdf visual/material, urdf robot/material
    red = '<material name="red"><color rgba="1 0 0 1"/></material>'
    shape = '<visual><geometry><sphere radius="1"/></geometry>{}</visual>'
    text = red + link("a", shape.format('<material name="red"/>') + shape.format(red))
    assert [visual.material for visual in read(text).links[0].visuals] == [None, None]
    named = read(text + gazebo("<material>Gazebo/DarkGrey</material>", "a")).links[0].visuals
    assert {visual.material.diffuse for visual in named} == {(0.175, 0.175, 0.175, 1)}


# --- joints

@pytest.mark.parametrize("kind, made", [
    ("revolute", "revolute"), ("continuous", "continuous"), ("prismatic", "prismatic")])
def test_moving_joints(kind, made):
    # conforms: urdf joint, urdf joint/parent, urdf joint/child, urdf joint/axis, urdf joint/origin
    # conforms: URDF joint types/revolute, URDF joint types/continuous, URDF joint types/prismatic
    # conforms: URDF joint types
    origin = '<origin xyz="0 0 1" rpy="0 0 1"/>'
    text = link("a") + link("b") + joint("j", "a", "b", kind, origin + HINGE)
    model = read(text)
    found = model.joints[0]
    assert (found.type, found.parent, found.child, found.axis) == (made, "a", "b", (0, 0, 1))
    assert ((found.lower, found.upper) == (-1, 2)) == (kind != "continuous")
    assert model.links[1].pose.position == (0, 0, 1)
    assert model.links[1].pose.rpy() == pytest.approx((0, 0, 1))


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_free_joints_are_no_joints_and_leave_the_child_free(kind):
    # conforms: URDF joint types/floating, URDF joint types/planar
    place = '<axis xyz="0 0 1"/><origin xyz="1 2 3"/>'
    model = read(link("a") + link("b") + joint("j", "a", "b", kind, place))
    assert model.joints == () and model.links[1].pose.position == (1, 2, 3)


def test_limits_and_dynamics(caplog):
    # conforms: urdf joint/limit, urdf joint/dynamics
    found = only_joint("revolute", HINGE + '<dynamics damping="5" friction="6"/>')
    assert (found.lower, found.upper, found.effort, found.velocity) == (-1, 2, 3, 4)
    assert (found.damping, found.friction) == (5, 6)
    turned = only_joint("revolute", HINGE.replace("-1", "9"))
    assert (turned.lower, turned.upper) == (2, 9) and "switching the two" in caplog.text
    assert "lower limit 9 is above upper limit 2" in caplog.text
    assert only_joint("continuous", HINGE).upper >= 1e15
    assert only_joint("prismatic", LIMIT).axis == (1, 0, 0)


def test_what_the_simulator_leaves_alone():
    # conforms: urdf joint/mimic, urdf joint/safety_controller, urdf joint/calibration
    more = """<mimic joint="k" multiplier="2"/><safety_controller k_velocity="1"/>
        <calibration rising="0"/>"""
    assert only_joint("revolute", HINGE + more) == only_joint("revolute", HINGE)


def test_fixed_joints_are_lumped_with_their_shapes_masses_sensors():
    # conforms: URDF conversion/fixed joints, URDF joint types/fixed, URDF conversion/lumped names
    sensor = """<sensor name="s" type="imu"><pose>0 0 1 0 0 0</pose></sensor>
        <light name="l" type="spot"><pose>0 0 1 0 0 0</pose></light>"""
    origin = '<origin xyz="0 0 2"/>'
    model = read(link("a", SHAPES) + link("b", SHAPES) + joint("j", "a", "b", more=origin)
                 + gazebo(sensor, "b"))
    (found,) = model.links
    assert found.inertial.mass == 2 and found.inertial.pose.position == (0, 0, 1)
    assert [part.name for part in found.collisions] == [
        "a_collision", "a_fixed_joint_lump__b_collision_1"]
    assert [part.name for part in found.visuals] == [
        "a_visual", "a_fixed_joint_lump__b_visual_1"]
    assert found.visuals[1].pose.position == (0, 0, 2)
    assert found.sensors[0].pose.position == found.lights[0].pose.position == (0, 0, 3)


def test_lumped_visuals_are_named_after_themselves_or_their_links():
    ball = "<visual {}><geometry><sphere radius='1'/></geometry></visual>"
    shapes = ball.format("name='nose'") + ball.format("")
    model = read(link("a", ball.format("")) + link("b", shapes)
                 + joint("ab", "a", "b"))
    assert [visual.name for visual in model.links[0].visuals] == [
        "a_visual", "a_fixed_joint_lump__nose_visual_1", "a_fixed_joint_lump__b_visual_2"]


def test_a_link_named_world_is_the_world():
    # conforms: URDF conversion/world link
    model = read('<link name="world"/>' + link("a")
                 + joint("j", "world", "a", more='<origin xyz="1 0 0"/>'))
    assert [found.name for found in model.links] == ["a"]
    assert (model.joints[0].parent, model.joints[0].type) == ("world", "fixed")
    assert model.links[0].pose.position == (1, 0, 0)


def test_plugins_and_joints_follow_lumping():
    # conforms: URDF conversion/plugins that name lumped links
    # conforms: URDF conversion/joints that name lumped links
    plugin = """<plugin name="p" filename="x"><bodyName>b</bodyName><frameName>b</frameName>
        <xyzOffset>1 0 0</xyzOffset></plugin>"""
    weld = '<link name="c"/><joint name="w" type="fixed"><parent>b</parent><child>c</child></joint>'
    origin = '<origin xyz="0 0 2" rpy="0 0 0.5"/>'
    model = read(link("a") + link("b") + joint("j", "a", "b", more=origin)
                 + gazebo(plugin) + gazebo(weld))
    element = model.plugins[0].element
    assert element.findtext("bodyName") == element.findtext("frameName") == "a"
    xyz, rpy = ([float(word) for word in element.findtext(tag).split()]
                for tag in ("xyzOffset", "rpyOffset"))
    assert xyz == pytest.approx([math.cos(0.5), math.sin(0.5), 2])
    assert rpy == pytest.approx([0, 0, 0.5])
    assert (model.joints[0].parent, model.joints[0].child) == ("a", "c")


def test_contact_sensors_follow_lumping():
    # conforms: URDF conversion/contact sensors that name lumped collisions
    sensor = """<sensor name="s" type="contact"><contact><collision>b_collision</collision>
        </contact></sensor>"""
    model = read(link("a", SHAPES) + link("b", SHAPES) + joint("j", "a", "b") + gazebo(sensor, "b"))
    named = model.links[0].sensors[0].element.findtext("contact/collision")
    assert named == "a_fixed_joint_lump__b_collision_1"


def test_a_link_of_sdf_s_may_lie_relative_to_one_of_urdf_s():
    model = read(link("a") + link("b") + """<joint name="j" type="continuous">
        <parent link="a"/><child link="b"/><origin xyz="1 0 0" rpy="0 0 1.5707963"/></joint>
        <gazebo><link name="extra"><pose relative_to="b">2 0 3 0 0 0</pose></link></gazebo>""")
    assert model.links[2].pose.position == pytest.approx((1.0, 2.0, 3.0), abs=1e-6)


def test_a_chain_too_long_is_one_line():
    # conforms: URDF conversion/limits of size
    links = "".join(link(f"l{i}") for i in range(300))
    joints = "".join(joint(f"j{i}", f"l{i}", f"l{i + 1}") for i in range(299))
    with pytest.raises(FormatError, match="more than 200 joints one after another"):
        read(links + joints)


# --- <gazebo>

def test_robot_level_tags():
    # conforms: urdf gazebo/static, urdf gazebo/plugin, urdf gazebo/self_collide
    # conforms: urdf gazebo/link, urdf gazebo/joint, urdf robot/origin
    model = read(link("a") + link("arm") + joint("shoulder", "a", "arm")
                 + '<origin xyz="1 2 3"/>'
                 + gazebo("<static>YES</static><self_collide>true</self_collide>")
                 + gazebo('<plugin name="p" filename="libx.so"/><link name="extra"/>'
                          '<joint name="w" type="fixed"><parent>arm</parent><child>extra</child>'
                          "</joint>"))
    assert model.static and model.self_collide and model.pose.position == (1, 2, 3)
    assert [plugin.filename for plugin in model.plugins] == ["libx.so"]
    assert [found.name for found in model.links] == ["a", "extra"]
    (weld,) = model.joints
    assert (weld.name, weld.parent, weld.child) == ("w", "a", "extra")
    assert not read(link("a")).static


@pytest.mark.parametrize("tag, field, value", [
    ("<mu1>0.3</mu1>", "mu", 0.3), ("<mu2>0.4</mu2>", "mu2", 0.4),
    ('<mu1 value="0.5"/>', "mu", 0.5), ("<fdir1>0 1 0</fdir1>", "fdir1", (0, 1, 0)),
    ("<kp>1e5</kp>", "kp", 1e5), ("<kd>7</kd>", "kd", 7),
    ("<minDepth>0.002</minDepth>", "min_depth", 0.002), ("<maxVel>0.5</maxVel>", "max_vel", 0.5),
])
def test_surface_tags(tag, field, value):
    # conforms: urdf gazebo@link/mu1, urdf gazebo@link/mu2, urdf gazebo@link/fdir1
    # conforms: urdf gazebo@link/kp, urdf gazebo@link/kd
    assert getattr(surface_of(tag), field) == value
    assert getattr(surface_of(""), field) != value


def test_link_tags():
    # conforms: urdf gazebo@link/turnGravityOff, urdf gazebo@link/gravity
    # conforms: urdf gazebo@link/dampingFactor
    # conforms: urdf gazebo@link/selfCollide, urdf gazebo@link/laserRetro
    # conforms: urdf gazebo@link/sensor, urdf gazebo@link/light
    usual = read(link("a", SHAPES)).links[0]
    found = read(link("a", SHAPES) + gazebo("""<turnGravityOff>true</turnGravityOff>
        <dampingFactor>0.2</dampingFactor><selfCollide>1</selfCollide><laserRetro>9</laserRetro>
        <sensor name="s" type="ray"/><light name="l" type="spot"/>""", "a")).links[0]
    assert (usual.gravity, usual.self_collide, usual.angular_damping) == (True, False, 0)
    assert (found.gravity, found.self_collide, found.angular_damping) == (False, True, 0.2)
    assert found.linear_damping == 0.2 and found.collisions[0].laser_retro == 9
    assert (found.sensors[0].type, found.lights[0].type) == ("ray", "spot")
    assert not read(link("a") + gazebo("<gravity>0</gravity>", "a")).links[0].gravity


def test_material_visual_and_collision_tags():
    # conforms: urdf gazebo@link/material, urdf gazebo@link/visual, urdf gazebo@link/collision
    named = read(link("a", SHAPES) + gazebo("<material>Gazebo/Blue</material>", "a")).links[0]
    assert named.visuals[0].material.diffuse == (0, 0, 1, 1)
    both = read(link("a", SHAPES) + gazebo("""<material>Gazebo/Blue</material>
        <visual><material><ambient>1 0 0 1</ambient></material></visual>""", "a")).links[0]
    material = both.visuals[0].material
    assert (material.ambient, material.diffuse) == ((1, 0, 0, 1), (0, 0, 1, 1))
    written = read(link("a", SHAPES) + gazebo("""
        <material><ambient>1 0 0 1</ambient></material>
        <visual><transparency>0.5</transparency></visual>
        <collision><surface><bounce><restitution_coefficient>0.7</restitution_coefficient>
        <threshold>0</threshold></bounce></surface></collision>""", "a")).links[0]
    assert written.visuals[0].material.ambient == (1, 0, 0, 1)
    assert written.visuals[0].transparency == 0.5
    assert written.collisions[0].surface.restitution == 0.7


def test_lumped_extensions_know_their_shapes_by_name():
    # conforms: URDF conversion/extensions of lumped links
    own = '<collision name="{}"><geometry><sphere radius="1"/></geometry></collision>'
    shapes = SHAPES + own.format("side") + own.format("b_side")
    model = read(link("a", SHAPES) + link("b", shapes) + joint("j", "a", "b")
                 + gazebo("<mu1>0.1</mu1><material>Gazebo/Red</material>", "b"))
    assert [part.surface.mu for part in model.links[0].collisions] == [1.0, 0.1, 1.0, 0.1]
    assert model.links[0].visuals[0].material is None
    assert model.links[0].visuals[1].material.diffuse == (1, 0, 0, 1)


def test_tags_that_refer_to_nothing_are_one_warning(caplog):
    # conforms: URDF conversion/references to nothing
    read(link("a") + gazebo("<mu1>1</mu1>", "wheeel") + gazebo("<mu2>1</mu2>", "wheeel"))
    assert caplog.text.count("'wheeel'") == 1


def test_joint_tags():
    # conforms: urdf gazebo@joint, urdf gazebo@joint/provideFeedback
    # conforms: urdf gazebo@joint/springReference, urdf gazebo@joint/springStiffness
    usual = only_joint("revolute", HINGE)
    found = only_joint("revolute", HINGE, gazebo("""<provideFeedback>true</provideFeedback>
        <springReference>0.5</springReference><springStiffness>6</springStiffness>""", "j"))
    assert not usual.provide_feedback and found.provide_feedback
    assert (found.spring_reference, found.spring_stiffness) == (0.5, 6)


def test_fixed_joints_that_are_kept():
    # conforms: urdf gazebo@joint/preserveFixedJoint, urdf gazebo@joint/disableFixedJointLumping
    disable = "<disableFixedJointLumping>true</disableFixedJointLumping>"
    preserve = "<preserveFixedJoint>true</preserveFixedJoint>"
    up = '<origin xyz="0 0 1"/>'
    text = (link("a") + link("b") + link("c") + joint("ab", "a", "b", more=up)
            + joint("bc", "b", "c", more=up))
    model = read(text + gazebo(preserve, "ab") + gazebo(disable, "bc"))
    kept, stiff = model.joints
    assert kept.type == "fixed"
    assert (stiff.type, stiff.lower, stiff.upper) == ("revolute", 0, 0)
    assert model.links[2].pose.position == (0, 0, 2)
    (both,) = read(text + gazebo(disable + preserve, "ab")).joints
    assert (both.name, both.type) == ("ab", "fixed")
    assert read(text).joints == ()


# --- files

def test_package_uris_become_folders_everywhere(tmp_path):
    (tmp_path / "ball.stl").write_bytes(b"")
    found = Resources(find_package={"pkg": str(tmp_path)}.__getitem__)
    model = read(link("a", """<visual><geometry>
        <mesh filename="package://pkg/ball.stl" scale="2 2 2"/></geometry></visual>""")
        + """<gazebo><plugin name="p" filename="f"><file>package://pkg/x.yaml</file></plugin>
        </gazebo>"""
        + "<!-- package://gone/x -->", found)
    mesh = model.links[0].visuals[0].geometry
    assert (mesh.path, mesh.scale) == (str(tmp_path / "ball.stl"), (2, 2, 2))
    assert model.plugins[0].element.findtext("file") == f"{tmp_path}/x.yaml"


def test_unknown_package_is_an_error():
    part = '<visual><geometry><mesh filename="package://gone/a.stl"/></geometry></visual>'
    with pytest.raises(FormatError, match=r"^urdf reference package name does not exist: gone$"):
        read(link("a", part), Resources(find_package={}.__getitem__))


def test_missing_mesh_is_one_warning_and_the_robot_still_loads(tmp_path, caplog):
    caplog.set_level(logging.WARNING)
    part = '<{0}><geometry><mesh filename="package://pkg/meshes/gone.stl"/></geometry></{0}>'
    model = read(link("a", part.format("visual") + part.format("collision")),
                 Resources(find_package={"pkg": str(tmp_path)}.__getitem__))
    assert model.links[0].visuals == model.links[0].collisions == ()
    assert len(caplog.records) == 1
    assert "gone.stl" in caplog.text and f"searched: {tmp_path / 'meshes'}" in caplog.text
