"""What the tools work out of messages that come in: rates, samples, frames, lines, parameters."""

import math
import time
from types import SimpleNamespace

import pytest
import rosbag
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from rospy import Time
from sim_viewer.registry import Refused
from sim_viewer.tools.bags import (
    Bags,
    bag_path,
    check_topic,
    contents,
    existing_bag,
    listing,
    new_bag,
)
from sim_viewer.tools.clock import FactorMeter
from sim_viewer.tools.console import line_of, pick
from sim_viewer.tools.parameters import check_name, read_value, rows, to_yaml
from sim_viewer.tools.plot import sample_time, thin
from sim_viewer.tools.tf import FrameTree
from sim_viewer.tools.topics import RateMeter
from std_msgs.msg import Float64


def test_a_rate_is_that_of_the_last_seconds():
    meter = RateMeter()
    for i in range(200):
        meter.add(i * 0.05)
    read = meter.read(199 * 0.05)
    assert read["rate"] == pytest.approx(20.0)
    assert read["longest"] == pytest.approx(0.05)
    assert read["count"] == 200
    assert meter.read(199 * 0.05 + 2.0)["rate"] < 15.0  # it has fallen silent
    assert meter.read(30.0)["rate"] == 0.0


def test_the_real_time_factor_starts_anew_after_a_reset():
    meter = FactorMeter()
    assert meter.add(0.0, 10.0) is None
    assert meter.add(1.0, 10.5) == pytest.approx(0.5)
    assert meter.add(1.2, 0.0) is None
    assert meter.add(2.2, 2.0) == pytest.approx(2.0)
    assert meter.add(2.4, None) is None


def test_a_sample_has_its_headers_time_if_that_is_of_today():
    message = Odometry()
    message.header.stamp = Time(100.5)
    assert sample_time(message, 100.6) == 100.5
    assert sample_time(message, 900.0) == 900.0  # from a bag
    assert sample_time(Odometry(), 100.6) == 100.6
    assert sample_time(Float64(1.0), 100.6) == 100.6


def test_thinning_keeps_peaks_order_and_true_samples():
    samples = [(i * 0.001, math.sin(i)) for i in range(1000)]
    samples[517] = (0.517, 9.0)
    kept = thin(samples, 100)
    assert len(kept) <= 100
    assert set(kept) <= set(samples)
    assert (0.517, 9.0) in kept
    assert kept == sorted(kept)
    assert thin(samples[:100], 100) == samples[:100]
    assert len(thin([(float(i), math.nan) for i in range(500)], 100)) <= 100


def frame(parent, child, stamp=0.0, **place):
    one = TransformStamped(child_frame_id=child)
    one.header.frame_id, one.header.stamp = parent, Time(stamp)
    one.transform.rotation.w = 1.0
    for axis, value in place.items():
        setattr(one.transform.translation, axis, value)
    return one


def test_frames_come_after_their_parents_with_rate_and_age():
    tree = FrameTree()
    tree.add([frame("/base", "/laser", x=0.1)], "/static", True, 0.0)
    for i in range(11):
        tree.add([frame("odom", "base", stamp=i * 0.1)], "/gazebo", False, i * 0.1)
    found = tree.rows(wall=1.0, now=1.25)
    assert [(row["frame"], row["depth"]) for row in found] == [
        ("odom", 0), ("base", 1), ("laser", 2)]
    base, laser = found[1:]
    assert base["rate"] == pytest.approx(10.0)
    assert base["age"] == pytest.approx(0.25)
    assert (laser["static"], laser["age"], laser["place"][0]) == (True, None, 0.1)
    assert laser["publisher"] == "/static"


def test_two_parents_and_a_loop_are_told():
    tree = FrameTree()
    tree.add([frame("map", "odom"), frame("world", "odom")], "/a", False, 0.0)
    tree.add([frame("a", "b"), frame("b", "a")], "/a", False, 0.0)
    by_name = {row["frame"]: row for row in tree.rows(1.0, 1.0)}
    assert by_name["odom"]["problem"] == "parents: world, map"
    assert by_name["a"]["problem"] == "loop"
    assert len(by_name) == 4  # world, odom, a, b



def test_lines_are_picked_by_level():
    def log(level, text="x"):
        return line_of(Log(level=level, msg=text, name="/n", file="f.py", line=7, function="go"))

    lines = [log(Log.DEBUG), log(Log.INFO), log(Log.WARN), log(Log.ERROR), log(Log.FATAL)]
    assert [line["level"] for line in pick(lines, "warn")] == ["warn", "error", "fatal"]
    assert lines[0]["place"] == "f.py:7 go"
    assert len(log(Log.INFO, "y" * 100_000)["text"]) < 2_100


def test_parameters_are_leaves_with_full_names():
    tree = {"a": {"b": 1, "c": [1, 2]}, "d": "x" * 500, "e": {}, "f": "one\ntwo"}
    found = {row["name"]: row for row in rows(tree)}
    assert [*found] == ["/a/b", "/a/c", "/d", "/e", "/f"]
    assert (found["/a/b"]["type"], found["/a/c"]["value"]) == ("int", "[1, 2]")
    assert found["/d"]["cut"] and not found["/a/b"]["cut"]
    assert found["/f"]["value"] == '"one\\ntwo"'
    assert rows({}) == []


@pytest.mark.parametrize("value", ["text", "1", "", "a\n b\n\n", 1, -2.5, True, [1, "x"],
                                   {"p": 1.0, "i": [True]}])
def test_a_value_survives_the_editor(value):
    assert read_value(to_yaml(value)) == value
    assert type(read_value(to_yaml(value))) is type(value)


@pytest.mark.parametrize("text", ["", "2026-11-21", "3000000000", "{1: 2}", '{"a b": 1}',
                                  '"\\x01"', "[1, ", "[~]"])
def test_values_that_the_server_cannot_keep_are_refused(text):
    with pytest.raises(Refused):
        read_value(text)


@pytest.mark.parametrize("name", ["", "/", "a", "/a b", "/a//b", "//", "/-x", "/a\n"])
def test_names_that_are_none_are_refused(name):
    with pytest.raises(Refused):
        check_name(name)


@pytest.mark.parametrize("name", ["../x", "/etc/x", ".hidden", "-O", "a/b", "a b", "", "a\n",
                                  "x" * 81, "a\\b", "$(x)"])
def test_a_bag_has_a_safe_name(tmp_path, name):
    with pytest.raises(Refused):
        bag_path(tmp_path, name)


def test_a_bag_stays_in_its_folder_and_is_not_written_over(tmp_path):
    folder = tmp_path / "bags"
    path = new_bag(folder, "run_1")
    assert path == folder / "run_1.bag"
    path.write_bytes(b"")
    with pytest.raises(Refused, match="exists already"):
        new_bag(folder, "run_1.bag")
    (folder / "out.bag").symlink_to(tmp_path / "secret.bag")
    with pytest.raises(Refused, match="leads out"):
        existing_bag(folder, "out")
    with pytest.raises(Refused, match=r"no run_2\.bag"):
        existing_bag(folder, "run_2")
    assert new_bag(folder, "").suffix == ".bag"
    assert [bag["name"] for bag in listing(folder)] == ["run_1.bag"]
    with pytest.raises(Refused, match="cannot be read"):
        contents(path)


def write_bag(path, topics, each):
    with rosbag.Bag(str(path), "w") as bag:
        for number in range(topics * each):
            bag.write(f"/t{number % topics}", Float64(1.0), Time(1 + number))
    return path


def test_the_contents_of_a_bag(tmp_path):
    assert contents(write_bag(tmp_path / "a.bag", topics=2, each=3)) == {
        "start": 1.0, "duration": 5.0, "messages": 6, "topics": [
            {"name": "/t0", "type": "std_msgs/Float64", "count": 3},
            {"name": "/t1", "type": "std_msgs/Float64", "count": 3}]}


def test_a_bag_of_many_topics_is_read_in_time_that_grows_as_it_does(tmp_path):
    path = write_bag(tmp_path / "a.bag", topics=4000, each=1)
    began = time.process_time()
    assert len(contents(path)["topics"]) == 4000
    assert time.process_time() - began < 2.0  # 0.1; it was 7


@pytest.mark.parametrize("topic", ["--all", "scan", "/a b", 5, "-O", "/x;y"])
def test_topics_to_record_are_names(topic):
    with pytest.raises(Refused):
        check_topic(topic)
    assert check_topic("/scan") is None


def test_a_stamp_without_seconds_attribute_is_no_header():
    assert sample_time(SimpleNamespace(header=3), 5.0) == 5.0


def test_a_folder_that_goes_away_ends_the_recording_with_a_word(tmp_path):
    asked = []
    recording = SimpleNamespace(running=True)

    def interrupt():
        asked.append("interrupt")
        recording.running = False

    recording.interrupt = interrupt
    kept = Bags(SimpleNamespace(options=SimpleNamespace(bags=str(tmp_path / "bags"))))
    kept.folder = tmp_path / "gone"
    kept._guard(recording)
    assert asked == ["interrupt"]
    assert kept.note == f"{tmp_path / 'gone'}: No such file or directory"
