"""Who talks to whom: rows of a robot's topics, and the sentences."""

from sim_viewer.tools.master import SystemState
from sim_viewer.tools.wiring import describe

OWN = "/sim_viewer"
CAMERA, IMAGE = "/camera/rgb/image_raw", "sensor_msgs/Image"
TYPES = {"/cmd_vel": "geometry_msgs/Twist", "/vel": "geometry_msgs/Twist", CAMERA: IMAGE,
         "/image": IMAGE, "/line": "std_msgs/Int32", "/lines": "std_msgs/Int32",
         "/tf": "tf2_msgs/TFMessage", "/scan": "sensor_msgs/LaserScan"}


def told(publishers=(), subscribers=(), sends=None):
    """What is described of a waffle in the simulator and these besides.

    `sends`: types by node and topic; the newest publisher's type is the master's.
    """
    sent = {CAMERA: ["/gazebo"], "/scan": ["/gazebo"], "/tf": ["/gazebo"]}
    heard = {"/cmd_vel": ["/gazebo"]}
    for ends, more in ((sent, publishers), (heard, subscribers)):
        for topic, node in more:
            ends.setdefault(topic, []).append(node)
    services = {"/gazebo/pause_physics": ["/gazebo"]}
    answers = {"/gazebo": {"/cmd_vel": "geometry_msgs/Twist"}} | (sends or {})
    types = TYPES | {topic: kind for each in (sends or {}).values() for topic, kind in each.items()}
    return describe(SystemState(sent, heard, services), types, OWN,
                    lambda node, _call: answers.get(node, {}))


def test_a_followers_drive_is_rows_and_no_fault():
    found = told([("/cmd_vel", "/follower")], [(CAMERA, "/follower"), (CAMERA, OWN)])
    assert found == {"faults": [], "loose": [], "rows": [
        {"name": "/cmd_vel", "type": "geometry_msgs/Twist", "part": "input",
         "from": ["/follower"], "to": ["/gazebo"]},
        {"name": CAMERA, "type": IMAGE, "part": "sensor",
         "from": ["/gazebo"], "to": ["/follower"]},
        {"name": "/scan", "type": "sensor_msgs/LaserScan", "part": "sensor",
         "from": ["/gazebo"], "to": []}]}


def test_two_drivers_are_a_fault_and_this_pages_keys_are_none():
    both = told([("/cmd_vel", "/follower"), ("/cmd_vel", "/teleop")])["faults"]
    assert [line[:47] for line in both] == ["/follower, /teleop may all send commands on /cm"]
    assert not told([("/cmd_vel", "/follower"), ("/cmd_vel", OWN + "_drive")])["faults"]


def test_who_sends_a_wrong_type_is_no_driver_but_a_fault():
    found = told([("/cmd_vel", "/follower"), ("/cmd_vel", "/rostopic_1")],
                 sends={"/rostopic_1": {"/cmd_vel": "std_msgs/String"}})
    assert found["faults"] == [
        "/rostopic_1 sends std_msgs/String on /cmd_vel, which takes geometry_msgs/Twist, so none "
        "of it arrives: end it, and send geometry_msgs/Twist"]
    row = found["rows"][0]
    assert (row["name"], row["type"], row["from"]) == (
        "/cmd_vel", "geometry_msgs/Twist", ["/follower"])


def test_a_rostopic_that_was_left_running_is_a_driver():
    (line,) = told([("/cmd_vel", "/follower"), ("/cmd_vel", "/rostopic_1_2")])["faults"]
    assert line.startswith("/follower, /rostopic_1_2 may all send")


def test_commands_that_nobody_hears_name_the_topic_that_is_meant():
    found = told([("/vel", "/follower")])
    assert found["loose"] == []
    assert found["faults"] == ["/follower sends commands on /vel, but nobody hears them there; "
                               "the robot listens on /cmd_vel"]


def test_an_image_that_nobody_sends_names_the_cameras_topic():
    (line,) = told([], [("/image", "/follower")])["faults"]
    assert line.startswith("/follower waits for sensor_msgs/Image on /image, but nobody")
    assert line.endswith(f"the simulator publishes {CAMERA}")


def test_other_topics_with_one_end_are_loose():
    found = told([("/line", "/finder")], [("/lines", "/follower"), ("/clock", "/follower")])
    assert found["faults"] == []
    assert found["loose"] == [
        "/follower waits for /lines, which nobody sends; of this type there are: /line",
        "/finder sends /line, which nobody hears"]


def test_commands_that_nobody_hears_are_a_fault_also_while_another_node_drives():
    found = told([("/cmd_vel", "/follower"), ("/vel", "/teleop")])
    assert found["loose"] == []
    assert found["faults"] == ["/teleop sends commands on /vel, but nobody hears them there; "
                               "the robot listens on /cmd_vel"]


def test_a_programs_window_is_no_sensor_and_odometry_is_one():
    window, odom = "/follower/windows/mask", "/odom"
    TYPES.update({window: IMAGE, odom: "nav_msgs/Odometry"})
    rows = {row["name"] for row in told([(window, "/follower"), (odom, "/gazebo")])["rows"]}
    assert odom in rows and window not in rows
