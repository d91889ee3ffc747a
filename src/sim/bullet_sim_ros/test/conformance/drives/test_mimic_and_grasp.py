"""Grippers: mimic joints, grasps that are held, vacuum, links that are tied together."""

import logging

import pytest

from bullet_sim.physics.weld import Weld
from bullet_sim.pose import Pose

MIMICS = ("libroboticsgroup_gazebo_mimic_joint_plugin.so",
          "libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so",
          "libgazebo_mimic_joint_plugin.so")
DISABLE = "libroboticsgroup_gazebo_disable_link_plugin.so"
GRASP = "libgazebo_grasp_fix.so"
GRASPS = (GRASP, "libgazebo_grasp_plugin.so")
VACUUM = "libgazebo_ros_vacuum_gripper.so"
FINGER_LIMITS = "<limit><lower>-0.1</lower><upper>0.1</upper></limit>"


def is_welded(model) -> bool:
    return any(isinstance(each, Weld) for each in model.bodies[0].attached)


@pytest.fixture

def gripper(robots):
    """`gripper(plugins)`: two fingers that slide towards each other, 0.2 m apart, in the air."""
    def make(*plugins: str) -> str:
        palm = robots.link("palm", "0 0 1 0 0 0", robots.box(0.3, 0.1, 0.02), 1.0)
        anchor = robots.revolute("anchor", "world", "palm", "0 0 1", "fixed")
        fingers = "".join(
            robots.link(f"{side}_finger", f"{x} 0 0.95 0 0 0", robots.box(0.01, 0.05, 0.08), 0.1)
            + robots.revolute(f"{side}_slide", "palm", f"{side}_finger", axis, "prismatic",
                              FINGER_LIMITS)
            for side, x, axis in (("left", -0.1, "1 0 0"), ("right", 0.1, "-1 0 0")))
        return f'<model name="hand">{palm}{anchor}{fingers}{"".join(plugins)}</model>'
    return make


@pytest.fixture(params=MIMICS)
def mimic(request, robots, gripper):
    """`mimic(tag=value)`: the right finger follows the left one, by each name of the plugin."""
    def make(**tags) -> str:
        return gripper(robots.plugin(request.param, **{
            "joint": "left_slide", "mimicJoint": "right_slide", **tags}))
    return make


def slides(hand) -> tuple[float, float]:
    return hand.joints["left_slide"].position, hand.joints["right_slide"].position


def test_a_joint_mimics_another_one(bench, mimic):
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so
    # conforms: libgazebo_mimic_joint_plugin.so
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/joint
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/joint
    # conforms: libgazebo_mimic_joint_plugin.so/joint
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/mimicJoint
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/mimicJoint
    # conforms: libgazebo_mimic_joint_plugin.so/mimicJoint
    hand = bench.spawn(mimic())
    hand.joints["left_slide"].drive_velocity(0.1, 10.0)
    bench.run(0.5)
    left, right = slides(hand)
    assert left == pytest.approx(0.05, abs=0.005)
    assert right == pytest.approx(left, abs=1e-3)


def test_multiplier_and_offset(bench, mimic):
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/multiplier
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/multiplier
    # conforms: libgazebo_mimic_joint_plugin.so/multiplier
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/offset
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/offset
    # conforms: libgazebo_mimic_joint_plugin.so/offset
    hand = bench.spawn(mimic(multiplier=-0.5, offset=0.03))
    hand.joints["left_slide"].reset(0.04)
    hand.joints["left_slide"].drive_velocity(0.0, 100.0)
    bench.run(0.3)
    assert slides(hand)[1] == pytest.approx(-0.5 * 0.04 + 0.03, abs=1e-3)


def test_small_gaps_are_left_alone(bench, mimic):
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/sensitiveness
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/sensitiveness
    # conforms: libgazebo_mimic_joint_plugin.so/sensitiveness
    hand = bench.spawn(mimic(sensitiveness=0.05))
    left = hand.joints["left_slide"]
    left.reset(0.04)
    left.drive_velocity(0.0, 100.0)
    bench.run(0.3)
    assert slides(hand)[1] == pytest.approx(0.0, abs=1e-3)
    left.reset(0.08)
    bench.run(0.3)
    assert slides(hand)[1] == pytest.approx(0.04, abs=0.012)


@pytest.mark.parametrize("tag, effort, pushed", [
    ("<hasPID>true</hasPID>", 1.0, True), ("<hasPID/>", 0.001, False),
    ("<hasPID>false</hasPID>", 1.0, True)])
def test_with_a_pid_the_effort_is_bounded(bench, mimic, tag, effort, pushed):
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/hasPID
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/hasPID
    # conforms: libgazebo_mimic_joint_plugin.so/hasPID
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/maxEffort
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/maxEffort
    # conforms: libgazebo_mimic_joint_plugin.so/maxEffort
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/robotNamespace
    # conforms: libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so/robotNamespace
    # conforms: libgazebo_mimic_joint_plugin.so/robotNamespace
    for gain, value in (("p", 50.0), ("i", 0.0), ("d", 5.0)):
        bench.graph.parameters[f"/arm/gazebo_ros_control/pid_gains/right_slide/{gain}"] = value
    hand = bench.spawn(mimic(maxEffort=effort, robotNamespace="/arm").replace(
        "<maxEffort>", f"{tag}<maxEffort>"))
    hand.joints["left_slide"].reset(0.05)
    hand.joints["left_slide"].drive_velocity(0.0, 100.0)
    bench.run(0.5)
    assert (slides(hand)[1] > 0.03) == pushed


def test_a_mimic_joint_at_rest_lets_the_world_rest(bench, mimic):
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so
    hand = bench.spawn(mimic())
    hand.joints["left_slide"].reset(0.05)
    hand.joints["left_slide"].drive_velocity(0.0, 100.0)
    bench.run(1.5)
    assert bench.world._client.auto_disable.disabled


def test_mimic_joints_that_are_not_there(bench, mimic, caplog):
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/joint
    # conforms: libroboticsgroup_gazebo_mimic_joint_plugin.so/mimicJoint
    bench.spawn(mimic(mimicJoint="nope"))
    assert "no joint of model hand named 'nope'; there are: left_slide, right_slide" in caplog.text
    bench.delete("hand")
    bench.spawn(mimic(joint=""))
    assert "it needs a <joint>" in caplog.text
    bench.delete("hand")
    bench.spawn(mimic(hasPID="true"))
    assert "there is no parameter /gazebo_ros_control/pid_gains/right_slide/p" in caplog.text


def test_a_link_to_be_disabled_has_to_be_there(bench, gripper, robots, caplog):
    # conforms: libroboticsgroup_gazebo_disable_link_plugin.so
    bench.spawn(gripper(robots.plugin(DISABLE, link="left_finger")))
    assert not caplog.records
    bench.delete("hand")
    bench.spawn(gripper(robots.plugin(DISABLE, link="nope")))
    assert "no link of model hand named 'nope'" in caplog.text


# --- grasps

GRASP_TAGS = ("<palm_link>palm</palm_link><gripper_link>left_finger</gripper_link>"
              "<gripper_link>right_finger</gripper_link>")


@pytest.fixture
def grasp(bench, gripper, robots):
    """`grasp(inner, seconds)`: a smooth cube is pressed so long; gives hand and cube."""
    def make(inner: str = GRASP_TAGS, seconds: float = 1.0, filename: str = GRASP):
        hand = bench.spawn(gripper(robots.plugin(filename).replace("></", f">{inner}</")))
        cube = bench.spawn(robots.cube("cube", size=0.06, mass=0.05, mu=2.0),
                           Pose((0.0, 0.0, 0.95)))
        bench.world.configure_physics(gravity=(0.0, 0.0, 0.0))
        press(hand, 3.0)
        bench.run(seconds)
        return hand, cube
    return make


def press(hand, effort: float, rate: float = 0.2) -> None:
    for joint in hand.joints.values():
        joint.drive_velocity(rate, effort)


def fall(bench, cube) -> float:
    """How far it falls in a fifth of a second."""
    height = cube.pose.position[2]
    bench.world.configure_physics(gravity=(0.0, 0.0, -9.8))
    bench.run(0.2)
    return height - cube.pose.position[2]


@pytest.mark.parametrize("filename", GRASPS)
@pytest.mark.parametrize("inner", [
    GRASP_TAGS, f"<arm><arm_name>arm</arm_name>{GRASP_TAGS}</arm>"])
def test_what_two_fingers_press_is_held_and_let_go(bench, grasp, filename, inner):
    # conforms: libgazebo_grasp_fix.so, libgazebo_grasp_plugin.so
    # conforms: libgazebo_grasp_fix.so/arm, libgazebo_grasp_fix.so/palm_link
    # conforms: libgazebo_grasp_fix.so/gripper_link, libgazebo_grasp_fix.so/release_tolerance
    # conforms: libgazebo_grasp_plugin.so/arm, libgazebo_grasp_plugin.so/palm_link
    # conforms: libgazebo_grasp_plugin.so/gripper_link
    hand, cube = grasp(f"{inner}<update_rate>50</update_rate>", 0.6, filename)
    for joint in hand.joints.values():  # hardly any pressing, so that only the weld can hold it
        joint.drive_velocity(0.0, 100.0)
    assert fall(bench, cube) < 0.002
    press(hand, 3.0, -0.5)
    bench.run(0.6)
    assert cube.pose.position[2] < 0.6


@pytest.mark.parametrize("filename", GRASPS)
@pytest.mark.parametrize("inner, held", [
    ("<update_rate>50</update_rate>", True),
    ("<update_rate>2</update_rate>", False),  # six updates take three seconds
    ("<update_rate>100</update_rate><grip_count_threshold>90</grip_count_threshold>"
     "<max_grip_count>91</max_grip_count>", False),  # a threshold of half would be reached
    ("<update_rate>10</update_rate><max_grip_count>2</max_grip_count>", True),
    ("<update_rate>10</update_rate><max_grip_count>40</max_grip_count>", False),  # half: 2 s
    ("<update_rate>50</update_rate><forces_angle_tolerance>181</forces_angle_tolerance>", False),
])
def test_how_long_and_from_where_it_has_to_be_pressed(grasp, inner, held, filename):
    # conforms: libgazebo_grasp_fix.so/update_rate, libgazebo_grasp_fix.so/grip_count_threshold
    # conforms: libgazebo_grasp_fix.so/max_grip_count
    # conforms: libgazebo_grasp_fix.so/forces_angle_tolerance
    # conforms: libgazebo_grasp_plugin.so/update_rate
    # conforms: libgazebo_grasp_plugin.so/grip_count_threshold
    # conforms: libgazebo_grasp_plugin.so/max_grip_count
    # conforms: libgazebo_grasp_plugin.so/forces_angle_tolerance
    _, cube = grasp(GRASP_TAGS + inner, 1.0, filename)
    assert is_welded(cube) == held


@pytest.mark.parametrize("filename", GRASPS)
def test_a_tolerance_keeps_it_held_while_the_fingers_open_a_bit(bench, grasp, filename):
    # conforms: libgazebo_grasp_fix.so/release_tolerance
    # conforms: libgazebo_grasp_plugin.so/release_tolerance
    tags = GRASP_TAGS + "<update_rate>50</update_rate><release_tolerance>0.05</release_tolerance>"
    hand, cube = grasp(tags, 0.6, filename)
    press(hand, 3.0, -0.1)
    bench.run(0.3)  # 3 cm
    assert is_welded(cube)
    bench.run(0.5)
    assert not is_welded(cube)


def test_what_is_held_may_be_deleted(bench, grasp):
    # conforms: libgazebo_grasp_fix.so
    grasp(GRASP_TAGS + "<update_rate>50</update_rate>", 0.6)
    bench.delete("cube")
    bench.run(0.2)
    bench.delete("hand")


def test_a_grasp_without_links_is_said(bench, gripper, robots, caplog):
    # conforms: libgazebo_grasp_fix.so/palm_link, libgazebo_grasp_fix.so/gripper_link
    bench.spawn(gripper(robots.plugin(GRASP)))
    assert "it needs a <palm_link>" in caplog.text
    bench.delete("hand")
    bench.spawn(gripper(robots.plugin(GRASP, palm_link="palm")))
    assert "it needs a <gripper_link>" in caplog.text


# --- vacuum

@pytest.fixture
def vacuum(bench, robots):
    """`vacuum(height, tag=value)`: a cup that hangs at 1 m, and a small cube near it."""
    def make(height: float = 0.97, **tags):
        bench.spawn(robots.cube("cup", robots.plugin(VACUUM, **{
            "bodyName": "body", "topicName": "grasping", **tags}), size=0.01).replace(
                "<link ", "<static>true</static><link "), Pose((0, 0, 1.0)))
        return bench.spawn(robots.cube("cube", size=0.01, mass=0.1), Pose((0, 0, height)))
    return make


def test_a_vacuum_holds_what_is_near_while_it_is_on(bench, vacuum):
    # conforms: libgazebo_ros_vacuum_gripper.so, libgazebo_ros_vacuum_gripper.so/bodyName
    # conforms: libgazebo_ros_vacuum_gripper.so/topicName
    cube = vacuum()
    told = bench.listen("/grasping")
    bench.call("/on")
    bench.run(0.5)
    assert len(told) == 500
    assert told[-1].data
    assert cube.pose.position[2] > 0.96
    bench.call("/off")
    told.clear()
    bench.run(0.3)
    assert not told[-1].data
    assert cube.pose.position[2] < 0.7


@pytest.mark.parametrize("tags, height, held", [
    ({}, 0.93, False), ({"maxDistance": 0.1}, 0.93, True), ({"maxDistance": 0.01}, 0.97, False)])
def test_how_far_a_vacuum_reaches(bench, vacuum, tags, height, held):
    # conforms: libgazebo_ros_vacuum_gripper.so/maxDistance
    cube = vacuum(height, **tags)
    bench.call("/on")
    bench.run(0.3)
    assert (cube.pose.position[2] > height - 0.02) == held


def test_what_is_very_near_goes_to_the_middle_of_the_cup(bench, vacuum):
    # conforms: libgazebo_ros_vacuum_gripper.so/minDistance
    cube = vacuum(0.97, minDistance=0.04, robotNamespace="/arm")
    bench.call("/arm/on")
    bench.run_steps(2)
    assert cube.pose.position[2] == pytest.approx(1.0, abs=1e-3)


def test_the_force_of_a_vacuum_is_bounded(bench, vacuum):
    # conforms: libgazebo_ros_vacuum_gripper.so/maxForce
    # conforms: libgazebo_ros_vacuum_gripper.so/robotNamespace
    cube = vacuum(0.97, maxForce=0.0, robotNamespace="/arm")
    bench.call("/arm/on")
    bench.run(0.5)
    # carried along, but not pulled against gravity: it sinks by g dt^2 a step
    assert cube.pose.position[2] == pytest.approx(0.97 - 500 * 9.8e-6, abs=1e-3)


# --- links tied together

TYING = """<sdf version="1.6"><world name="default">
  <plugin name="ties" filename="libgazebo_ros_link_attacher.so"/></world></sdf>"""


def test_links_are_tied_together_and_parted(make_bench, robots):
    # conforms: libgazebo_ros_link_attacher.so
    bench = make_bench(TYING)
    anchor = bench.spawn(robots.cube("anchor", size=0.1).replace(
        "<link ", "<static>true</static><link "), Pose((0, 0, 2.0)))
    cube = bench.spawn(robots.cube("cube", size=0.1), Pose((0.5, 0, 2.0)))
    ends = {"model_name_1": "anchor", "link_name_1": "body",
            "model_name_2": "cube", "link_name_2": "body"}
    assert bench.call("/link_attacher_node/attach", **ends).ok
    bench.run(0.5)
    assert cube.pose.position == pytest.approx((0.5, 0, 2.0), abs=2e-3)
    assert anchor.pose.position == pytest.approx((0, 0, 2.0))
    for reset in ("reset_world", "reset_simulation"):  # neither parts them
        bench.call(f"/gazebo/{reset}")
        bench.run(0.5)
        assert cube.pose.position == pytest.approx((0.5, 0, 2.0), abs=2e-3)
    assert bench.call("/link_attacher_node/detach", **ends).ok
    assert not bench.call("/link_attacher_node/detach", **ends).ok
    bench.run(0.5)
    assert cube.pose.position[2] < 1.0


def test_tying_what_is_not_there_is_not_ok(make_bench, robots, caplog):
    # conforms: libgazebo_ros_link_attacher.so
    bench = make_bench(TYING)
    bench.spawn(robots.cube("cube"))
    with caplog.at_level(logging.ERROR):
        answer = bench.call("/link_attacher_node/attach", model_name_1="cube", link_name_1="body",
                            model_name_2="nope", link_name_2="body")
    assert not answer.ok
    assert "cannot attach: no model named 'nope'; there are: cube" in caplog.text
