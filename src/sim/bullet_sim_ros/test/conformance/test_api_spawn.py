"""Spawning and deleting through the services of /gazebo."""

import math

import pytest
import rospkg
import rospy
from geometry_msgs.msg import Point, Pose, Quaternion

from bullet_sim.pose import Pose as Placement

DONE = (True, "SpawnModel: Successfully spawned entity")
TAKEN = (False, "SpawnModel: Failure - entity already exists.")
UPRIGHT = Quaternion(0, 0, 0, 1)
LEFT = Quaternion(0, 0, math.sqrt(0.5), math.sqrt(0.5))
INERTIAL = ('<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" '
            'iyz="0"/></inertial>')
URDF = f'<robot name="r"><link name="l">{INERTIAL}</link>{{}}</robot>'
SDF = '<sdf version="1.6"><model name="m">{}<link name="l"/></model></sdf>'
TRUTH = '<plugin name="p" filename="libgazebo_ros_p3d.so"><bodyName>l</bodyName>' \
        '<topicName>truth</topicName>{}</plugin>'
TF = "<link name='l'/><model name='in'><link name='k'/>" + TRUTH.format("").replace(
    ">l<", ">k<").replace("truth", "inner") + "</model>"


def near(*values):
    return pytest.approx(values, abs=1e-6)


def spawn(bench, xml, kind="sdf", name="new", pose=Pose(orientation=UPRIGHT), **fields):
    answer = bench.call(f"/gazebo/spawn_{kind}_model", model_name=name, model_xml=xml,
                        initial_pose=pose, **fields)
    return answer.success, answer.status_message


@pytest.mark.parametrize("kind, xml", [("urdf", URDF.format("")), ("sdf", SDF.format("")),
                                       ("sdf", URDF.format("")),
                                       ("sdf", SDF.format("").replace("sdf", "gazebo"))])
def test_a_model_gets_its_name_and_pose(bench, kind, xml):
    # conforms: /gazebo/spawn_urdf_model, /gazebo/spawn_sdf_model
    # conforms: /gazebo/spawn_urdf_model/model_name, /gazebo/spawn_sdf_model/model_name
    # conforms: /gazebo/spawn_urdf_model/model_xml, /gazebo/spawn_sdf_model/model_xml
    # conforms: /gazebo/spawn_urdf_model/initial_pose, /gazebo/spawn_sdf_model/initial_pose
    # conforms: /gazebo/spawn_urdf_model/success, /gazebo/spawn_sdf_model/success
    # conforms: /gazebo/spawn_urdf_model/status_message, /gazebo/spawn_sdf_model/status_message
    pose = Pose(Point(1, 2, 3), LEFT)
    assert spawn(bench, f'<?xml version="1.0"?>{xml}', kind, pose=pose) == DONE
    model = bench.world.model("new")
    assert model.pose.position == near(1, 2, 3) and model.pose.rpy() == near(0, 0, math.pi / 2)
    assert spawn(bench, xml, kind) == TAKEN


@pytest.mark.parametrize("kind, xml", [
    ("sdf", "<sdf version=1.6><model name='m'><link name='l'/></model></sdf> tail"),
    ("sdf", "<sdf version=1.6><light name='m' type='point'/></sdf> tail"),
    ("urdf", URDF.format("") + " tail")])
def test_what_is_not_xml_by_the_rules_is_said_once(bench, caplog, kind, xml):
    assert spawn(bench, xml, kind) == DONE
    assert caplog.text.count("taken all the same, as by Gazebo") == 1


def test_a_model_is_spawned_while_time_stands_still(bench):
    # conforms: /gazebo/spawn_sdf_model, /gazebo/pause_physics
    bench.call("/gazebo/pause_physics")
    assert spawn(bench, SDF.format("")) == DONE
    assert bench.world.time == 0.0


def test_the_models_own_pose_is_an_offset(bench):
    # conforms: /gazebo/spawn_sdf_model/initial_pose, /gazebo/spawn_urdf_model/initial_pose
    pose = Pose(Point(5, 0, 0), Quaternion(0, 0, 2, 2))  # not normalised
    spawn(bench, SDF.format("<pose>1 0 2 0 0 0.5</pose>"), pose=pose, name="a")
    origin = URDF.format('<origin xyz="1 0 2" rpy="0 0 0.5"/>')
    spawn(bench, origin, "urdf", pose=pose, name="b")
    for name in ("a", "b"):
        model = bench.world.model(name)
        assert model.pose.position == near(5, 1, 2)
        assert model.pose.rpy() == near(0, 0, math.pi / 2 + 0.5)


def test_no_orientation_at_all_is_none_and_cancels_the_offset(bench):
    # conforms: /gazebo/spawn_sdf_model/initial_pose, /gazebo/spawn_urdf_model/initial_pose
    blank = Pose(Point(5, 0, 1), Quaternion(0, 0, 0, 0))
    spawn(bench, SDF.format("<pose>1 0 2 0 0 0.5</pose>"), pose=blank, name="a")
    spawn(bench, URDF.format(""), "urdf", pose=blank, name="b")
    for name in ("a", "b"):
        assert bench.world.model(name).pose == Placement((5, 0, 1))


def test_a_pose_relative_to_another_entity(bench):
    # conforms: /gazebo/spawn_urdf_model/reference_frame, /gazebo/spawn_sdf_model/reference_frame
    spawn(bench, SDF.format(""), name="frame", pose=Pose(Point(3, 0, 0), LEFT))
    pose = Pose(Point(1, 0, 0), UPRIGHT)
    for number, frame in enumerate(("frame", "frame::l")):
        for kind, xml in (("sdf", SDF.format("")), ("urdf", URDF.format(""))):
            spawn(bench, xml, kind, f"{kind}{number}", pose, reference_frame=frame)
            model = bench.world.model(f"{kind}{number}")
            assert model.pose.position == near(3, 1, 0)
            assert model.pose.rpy() == near(0, 0, math.pi / 2)
    for number, frame in enumerate(("world", "map", "/map")):
        assert spawn(bench, SDF.format(""), name=f"w{number}", reference_frame=frame) == DONE
    assert spawn(bench, SDF.format(""), name="x", reference_frame="odom") == (
        False, "SpawnModel: reference reference_frame not found, did you forget to scope the "
        "link by model name?")
    assert "x" not in bench.world.models


def test_plugins_get_the_robots_namespace_unless_they_have_one(bench):
    # conforms: /gazebo/spawn_sdf_model/robot_namespace, /gazebo/spawn_urdf_model/robot_namespace
    own = TRUTH.format("<robotNamespace>/own</robotNamespace>").replace("truth", "kept")
    xml = SDF.format(TRUTH.format("") + own + TF.removeprefix("<link name='l'/>"))
    spawn(bench, xml, name="a", robot_namespace="/left")
    assert {"/left/truth", "/own/kept", "/left/inner"} <= set(bench.advertised())
    spawn(bench, URDF.format(f"<gazebo>{TRUTH.format('')}</gazebo>"), "urdf", "b",
          robot_namespace="/right")
    assert "/right/truth" in bench.advertised()
    spawn(bench, SDF.format(TRUTH.format("")), name="c")
    assert "/truth" in bench.advertised()


def test_texts_that_are_no_models(bench):
    # conforms: /gazebo/spawn_urdf_model/model_xml, /gazebo/spawn_sdf_model/model_xml
    # conforms: /gazebo/spawn_sdf_model/status_message
    with pytest.raises(rospy.ServiceException,
                       match="SpawnModel: Failure - entity format is invalid"):
        spawn(bench, SDF.format(""), "urdf")
    with pytest.raises(rospy.ServiceException,
                       match="urdf reference package name does not exist: no_such"):
        spawn(bench, URDF.format("<gazebo><a>package://no_such/x</a></gazebo>"), "urdf")
    for xml in ("<world/>", "hello", "", "<sdf><model name='a'>"):
        success, message = spawn(bench, xml)
        assert not success and "\n" not in message
        assert message.startswith(
            "GazeboRosApiPlugin SpawnModel Failure: input model_xml not SDF or URDF, or cannot "
            "be converted to Gazebo compatible format.")


def test_package_uris_anywhere_in_a_urdf_become_folders(bench):
    # conforms: /gazebo/spawn_urdf_model/model_xml
    folder = rospkg.RosPack().get_path("bullet_sim_ros")
    plugin = TRUTH.format("").replace("truth", "package://bullet_sim_ros/x")
    commented = "<!-- package://no_such/x -->"
    spawn(bench, URDF.format(f"<gazebo>{plugin}</gazebo>{commented}"), "urdf")
    topic = bench.world.model("new").description.plugins[0].element.findtext("topicName")
    assert topic == f"{folder}/x"


def test_a_model_by_the_name_of_its_folder(bench):
    # conforms: /gazebo/spawn_sdf_model/world include
    text = ('<sdf version="1.4"><world name="default"><include><uri>model://ground_plane</uri>'
            "{}</include></world></sdf>")
    pose = Pose(Point(0, 0, -4), UPRIGHT)
    assert spawn(bench, text.format(""), pose=pose) == DONE
    assert bench.world.model("new").pose.position == near(0, 0, -4)
    spawn(bench, text.format("<pose>1 0 0 0 0 0</pose>"), pose=pose, name="b")
    assert bench.world.model("b").pose.position == near(1, 0, -4)
    assert not spawn(bench, text.format("").replace("ground_plane", "no_such"), name="c")[0]


def test_a_model_without_a_wanted_name_keeps_its_own(bench):
    # conforms: /gazebo/spawn_sdf_model/model_name
    assert spawn(bench, SDF.format(""), name="") == DONE
    assert "m" in bench.world.models


def test_a_pose_that_is_no_number_is_refused(bench):
    # conforms: /gazebo/spawn_sdf_model/initial_pose
    assert "finite" in spawn(bench, SDF.format(""), pose=Pose(Point(math.nan, 0, 0), UPRIGHT))[1]


def test_a_deleted_model_falls_silent(bench):
    # conforms: /gazebo/delete_model, /gazebo/delete_model/model_name
    # conforms: /gazebo/delete_model/success, /gazebo/delete_model/status_message
    spawn(bench, SDF.format(TRUTH.format("")))
    messages = bench.listen("/truth")
    bench.run(0.01)
    assert messages
    answer = bench.call("/gazebo/delete_model", model_name="new")
    assert (answer.success, answer.status_message) == (
        True, "DeleteModel: successfully deleted model")
    assert "/truth" not in bench.advertised() and "new" not in bench.world.models
    answer = bench.call("/gazebo/delete_model", model_name="new")
    assert (answer.success, answer.status_message) == (
        False, "DeleteModel: model does not exist")
