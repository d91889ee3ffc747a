"""What a run in lockstep waits for before time may begin, and how it counts images."""

import pytest
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import CameraInfo

from run_session.course_file import load_course
from run_session.master import Connections
from run_session.observer import FrameCount, frame_figures, missing_connection, missing_controller

COURSE = load_course("course")
ME, SIMULATOR, FOLLOWER = "/course_run", "/gazebo", "/follower"
PUBLISHERS = {
    COURSE.camera: {SIMULATOR},
    COURSE.camera_info: {SIMULATOR},
    COURSE.commands: {FOLLOWER},
    COURSE.odometry: {SIMULATOR},
}
SUBSCRIBERS = {
    COURSE.camera: {FOLLOWER},
    COURSE.camera_info: {ME},
    COURSE.commands: {ME, SIMULATOR},
    COURSE.odometry: {ME},
}
LINKS = {
    (publisher, topic, subscriber)
    for topic, (publisher,) in PUBLISHERS.items()
    for subscriber in SUBSCRIBERS[topic]
}


def missing(
    publishers: dict | None = None, subscribers: dict | None = None, links: set = LINKS
) -> str | None:
    """As missing_connection says it where these topics are other than they should be."""

    def nodes(usual: dict, other: dict | None) -> dict:
        return {topic: frozenset(found) for topic, found in (usual | (other or {})).items()}

    found = Connections(
        nodes(PUBLISHERS, publishers), nodes(SUBSCRIBERS, subscribers), frozenset(links)
    )
    return missing_connection(found, ME, COURSE)


def test_nothing_is_missing_when_all_links_are_open():
    assert missing() is None


@pytest.mark.parametrize("publishers, link, said", [
    (frozenset(), False, "the car's sensors (nobody publishes /scan)"),
    (frozenset({SIMULATOR}), False, f"the connection of /scan from {SIMULATOR} to {ME}"),
    (frozenset({SIMULATOR}), True, None),
])
def test_a_sensor_that_is_listened_to_is_waited_for(publishers, link, said):
    """What it sent before that would be missing from one run's fingerprint and not another's."""
    links = LINKS | ({(SIMULATOR, "/scan", ME)} if link else set())
    assert missing({"/scan": publishers}, {"/scan": {ME}}, links) == said


@pytest.mark.parametrize("link", sorted(LINKS))
def test_each_link_is_waited_for(link):
    publisher, topic, subscriber = link
    said = f"the connection of {topic} from {publisher} to {subscriber}"
    assert missing(links=LINKS - {link}) == said


@pytest.mark.parametrize(
    ("publishers", "subscribers", "words"),
    [
        ({COURSE.camera: set()}, {}, "the camera (topic /camera/rgb/image_raw)"),
        ({COURSE.odometry: set()}, {}, "the odometry (topic /odom)"),
        ({}, {COURSE.camera: {ME}}, "the follower (nobody subscribes to /camera/rgb/image_raw)"),
        ({COURSE.commands: {ME}}, {}, "the follower (nobody publishes /cmd_vel)"),
        ({}, {COURSE.commands: {ME}}, "the car's drive (nobody subscribes to /cmd_vel)"),
    ],
)
def test_each_part_is_waited_for(publishers, subscribers, words):
    assert missing(publishers, subscribers) == words


def test_a_spectator_does_not_stand_for_the_follower():
    spectator = {COURSE.camera: {FOLLOWER, "/image_view"}}
    assert "from /gazebo to /image_view" in missing(subscribers=spectator)


def image(number: int) -> CameraInfo:
    info = CameraInfo()
    info.header.seq, info.header.stamp = number, rospy.Time.from_sec(number / 30)
    return info


def count(story: str, lockstep: bool) -> FrameCount:
    """Images (digits, their numbers) and commands (c) in the order in which they are heard."""
    frames = FrameCount(lockstep)
    for event in story:
        if event == "c":
            frames.count_command(Twist())
        else:
            frames.count_frame(image(int(event)))
    return frames


def test_images_count_from_the_one_that_the_first_command_answers():
    frames = count("1234c5c6c7c8c9c", lockstep=False)
    assert (frames.sent(1.0), frames.commands) == (6, 6)
    assert frames.sent(6 / 30) == 3
    assert frames.sent(0.0) == 0


def test_images_count_from_the_first_in_lockstep():
    frames = count("124c", lockstep=True)  # the third was not heard of
    assert (frames.sent(1.0), frames.commands) == (4, 1)


def test_all_images_of_a_time_have_come_when_a_later_one_has():
    frames = count("12", lockstep=True)
    assert frames.later_than(1 / 30) and not frames.later_than(2 / 30)


@pytest.mark.parametrize(
    ("log", "dropped"),
    [
        (None, 2),
        (["[INFO] all is well"], 0),  # the simulator heard them, else it would say so
        (["[WARN] lockstep: no message on /cmd_vel within 1 s of a camera frame"], 2),
    ],
)
def test_images_without_a_command_were_dropped(log, dropped):
    figures = frame_figures(10, 8, log)
    assert figures["frames_sent"] == 10 and figures["frames_dropped"] == dropped
    assert figures["frames_answered"] == 10 - dropped


def test_one_image_at_least_was_dropped_where_the_simulator_says_so():
    assert frame_figures(10, 12, ["lockstep: no message on /cmd_vel"])["frames_dropped"] == 1
    assert frame_figures(10, 12, None)["frames_dropped"] == 0


def test_each_controller_of_the_racecar_is_waited_for():
    """Loaded one after the other; a command to one that is not there yet would be lost."""
    race = load_course("race")
    topics = (race.camera, race.camera_info, race.commands, race.odometry, *race.lockstep)
    publishers = {topic: frozenset({SIMULATOR}) for topic in topics}
    publishers |= {race.commands: frozenset({FOLLOWER})}
    publishers |= {topic: frozenset({"/motor_control"}) for topic in race.lockstep}
    subscribers = {topic: frozenset({ME}) for topic in topics}
    subscribers[race.camera] = frozenset({FOLLOWER})
    subscribers[race.commands] = frozenset({"/motor_control"})
    links = frozenset((publisher, topic, subscriber) for topic in topics
                      for publisher in publishers[topic] for subscriber in subscribers[topic])
    subscribers |= {topic: frozenset({SIMULATOR}) for topic in race.lockstep[:-1]}
    subscribers |= {race.lockstep[-1]: frozenset()}
    found = Connections(publishers, subscribers, links)
    said = missing_connection(found, ME, race)
    assert said == f"the car's control (nobody subscribes to {race.lockstep[-1]})"


@pytest.mark.parametrize(("states", "wanted", "said"), [
    ({"drive": "running", "joints": "waiting"}, {"drive"}, None),
    ({}, set(), "the car's controllers (spawned and started)"),
    ({"joints": "running"}, {"drive"}, "controller drive (spawned and started)"),
    ({"drive": "initialized", "j": "running"}, set(), "controller drive (spawned and started)"),
])
def test_each_controller_is_waited_for(states, wanted, said):
    assert missing_controller(states, wanted) == said


@pytest.mark.parametrize("name", ["race", "lane", "lane_empty"])
def test_courses_whose_cars_are_driven_by_controllers_wait_for_them(name):
    """Time that begins before the drive is started begins at another tick of its own each time."""
    assert load_course(name).controllers
