"""A made-up bag in, a map and a trajectory out."""

import io

import numpy as np
import pytest
import rosbag
import rospy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from gmapping.replay import main
from map_server.map_files import read_map
from nav_algorithms.cells import OCCUPIED
from nav_nodes.messages import transform_message

HALF = 1.52  # m; the robot drives in a square room, from its middle
SETTINGS = ("_particles:=5", "_xmin:=-3", "_xmax:=3", "_ymin:=-3", "_ymax:=3",
            "_temporalUpdate:=0.1")


def scan_at(x: float, stamp: rospy.Time) -> LaserScan:
    angles = np.arange(120) * 2 * np.pi / 120
    with np.errstate(divide="ignore"):
        along = (np.where(np.cos(angles) > 0, HALF - x, HALF + x)) / abs(np.cos(angles))
        ranges = np.minimum(along, HALF / abs(np.sin(angles)))
    scan = LaserScan(angle_increment=angles[1], range_min=0.1, range_max=3.5, ranges=ranges)
    scan.header.stamp, scan.header.frame_id = stamp, "laser"
    return scan


@pytest.fixture
def bag(tmp_path):
    """Scans come before the odometry of their moment, as they do from a simulator."""
    path = tmp_path / "drive.bag"
    with rosbag.Bag(str(path), "w") as out:
        still = transform_message(np.zeros(3), "base_link", "laser", rospy.Time(1))
        out.write("/tf_static", TFMessage([still]), rospy.Time(1))
        for i in range(20):
            stamp = rospy.Time.from_sec(10 + 0.2 * i)
            out.write("/scan", scan_at(0.02 * i, stamp), stamp)
            moved = transform_message((0.02 * i, 0.0, 0.0), "odom", "base_link", stamp)
            later = stamp + rospy.Duration.from_sec(0.05)
            out.write("/tf", TFMessage([moved]), later)
    return path


def replay(bag, name, *more) -> int:
    return main([str(bag), "--map", str(bag.parent / name), *SETTINGS, *more])


def test_map_and_trajectory(bag, capsys):
    assert replay(bag, "room") == 0
    assert "20 scans of 4 s" in capsys.readouterr().out
    grid, _ = read_map(bag.parent / "room.yaml")
    assert grid.cells[tuple(grid.cells_of((HALF, 0.3)))] == OCCUPIED
    path = np.loadtxt(bag.parent / "room.tum")
    assert path.shape == (20, 8)
    assert path[-1, 0] == pytest.approx(13.8)
    assert path[-1, 1:3] == pytest.approx((0.38, 0.0), abs=0.02)


def test_scans_before_all_odometry_do_not_hold_up_slow_ones(tmp_path, capsys):
    """tf knows the last 30 s; who waited longer for one that can never be used would lose all."""
    path = tmp_path / "slow.bag"
    with rosbag.Bag(str(path), "w") as out:
        for i in range(70):
            stamp = rospy.Time(10 + i)
            out.write("/scan", scan_at(0.0, stamp), stamp)
            if i > 2:
                out.write("/tf", TFMessage([
                    transform_message(np.zeros(3), "odom", "base_link", stamp),
                    transform_message(np.zeros(3), "base_link", "laser", stamp)]), stamp)
    assert replay(path, "slow") == 0
    assert "67 scans of 66 s" in (said := capsys.readouterr().out) and "; 3 without" in said


def test_the_same_bag_and_seed_give_the_same_bytes(bag):
    results = []
    for name, seed in (("a", "4"), ("b", "4"), ("c", "5")):
        assert replay(bag, name, "--seed", seed) == 0
        results.append([(bag.parent / f"{name}.{kind}").read_bytes() for kind in ("pgm", "tum")])
    assert results[0] == results[1]
    assert results[0][1] != results[2][1]


@pytest.mark.parametrize("arguments, text", [
    (["_particels:=3"], "no parameter particels"), (["_particles:=many"], "type int"),
    (["--scan_topic", "front"], "no scans on /front; scans are on: /scan"),
    (["particles"], "NAME:=VALUE"),
    (["_base_frame:=robot"],
     "none of the 20 scans on /scan can be placed: no transform from odom to robot")])
def test_what_is_wrong_is_said_in_one_line(bag, capsys, arguments, text):
    assert replay(bag, "none", *arguments) == 1
    said = capsys.readouterr().err
    assert text in said and said.count("\n") == 1
    assert not (bag.parent / "none.pgm").exists()


@pytest.mark.parametrize("arguments, text", [
    ([], "required: bag; usage:"), (["a.bag", "--seed", "x"], "invalid int value: 'x'; usage:")])
def test_a_wrong_command_is_one_line(capsys, arguments, text):
    with pytest.raises(SystemExit) as end:
        main(arguments)
    said = capsys.readouterr().err
    assert end.value.code == 1 and text in said and said.count("\n") == 1


def test_names_of_a_bag_stay_on_one_line(tmp_path, capsys):
    path = tmp_path / "names.bag"
    with rosbag.Bag(str(path), "w") as out:
        out.write("/a\nb", scan_at(0.0, rospy.Time(1)), rospy.Time(1))
    assert replay(path, "none") == 1
    said = capsys.readouterr().err
    assert said.endswith("no scans on /scan; scans are on: /a b\n") and said.count("\n") == 1


def test_a_bag_that_is_not_there_is_one_line(capsys):
    assert main(["nowhere.bag"]) == 1
    assert capsys.readouterr().err == (
        "slam_gmapping_replay: nowhere.bag: No such file or directory\n")


@pytest.mark.parametrize("text, said", [
    ("", "NAME: VALUE lines"), ("- particles", "NAME: VALUE lines"), ("a: [", "is not valid YAML"),
    ("a: 2020-13-45", "is not valid YAML"), ("a: !!int ''", "is not valid YAML"),
    ("[" * 1000, "is not valid YAML")])
def test_a_file_of_parameters_that_is_none(bag, capsys, tmp_path, text, said):
    (tmp_path / "slam.yaml").write_text(text)
    assert replay(bag, "none", "--params", str(tmp_path / "slam.yaml")) == 1
    line = capsys.readouterr().err
    assert said in line and "slam.yaml" in line and line.count("\n") == 1


@pytest.mark.parametrize("text, said", [
    ("1: 2", "no parameter 1"), ("delta: 1" + "0" * 400, "must be of type double")])
def test_a_parameter_that_cannot_be(bag, capsys, tmp_path, text, said):
    (tmp_path / "slam.yaml").write_text(text)
    assert replay(bag, "none", "--params", str(tmp_path / "slam.yaml")) == 1
    line = capsys.readouterr().err
    assert said in line and line.count("\n") == 1


def test_scans_of_no_use_are_counted_and_the_rest_is_mapped(tmp_path, capsys):
    path = tmp_path / "absurd.bag"
    with rosbag.Bag(str(path), "w") as out:
        for i in range(6):
            stamp, scan = rospy.Time(10 + i), scan_at(0.0, rospy.Time(10 + i))
            if i < 2:
                scan.ranges, scan.range_max = [1e6] * 120, 1e7
            out.write("/tf", TFMessage([
                transform_message(np.zeros(3), "odom", "base_link", stamp),
                transform_message(np.zeros(3), "base_link", "laser", stamp)]), stamp)
            out.write("/scan", scan, stamp)
    assert replay(path, "absurd") == 0
    said, line = capsys.readouterr()
    assert "4 scans of 3 s" in said
    assert "2 scans of no use, the first: a scan of 1e+06 m" in line and line.count("\n") == 1


@pytest.mark.parametrize("topic, kind", [("/scan", "sensor_msgs/LaserScan"),
                                         ("/tf", "tf2_msgs/TFMessage")])
def test_a_topic_of_another_type_is_said_in_one_line(tmp_path, capsys, topic, kind):
    with rosbag.Bag(str(tmp_path / "other.bag"), "w") as out:
        out.write(topic, String("hello"), rospy.Time(1))
    assert replay(tmp_path / "other.bag", "none") == 1
    said = capsys.readouterr().err
    assert said.endswith(f"other.bag: {topic} is of std_msgs/String, not {kind}\n")


def test_a_message_that_is_cut_off_is_said_in_one_line(tmp_path, capsys):
    cut = (LaserScan._type, b"\0" * 30, LaserScan._md5sum, LaserScan)
    with rosbag.Bag(str(tmp_path / "cut.bag"), "w") as out:
        out.write("/scan", cut, rospy.Time(1), raw=True)
    assert replay(tmp_path / "cut.bag", "none") == 1
    said = capsys.readouterr().err
    assert "cut.bag: unpack requires a buffer" in said and said.count("\n") == 1


@pytest.mark.parametrize("frame, second", [
    ("la\0ser", 1), ("laser", 2**32 - 1)])  # of the second tf2 ends the process
def test_a_scan_that_tf2_does_not_take_is_left_out(tmp_path, capsys, frame, second):
    with rosbag.Bag(str(tmp_path / "odd.bag"), "w") as out:
        for child, parent in (("laser", "base_link"), ("base_link", "odom")):
            for stamp in (rospy.Time(1), rospy.Time(2), rospy.Time(second, 5)):
                out.write("/tf", TFMessage([transform_message(np.zeros(3), parent, child, stamp)]),
                          rospy.Time(1))
        odd = scan_at(0.0, rospy.Time(second))
        odd.header.frame_id = frame
        out.write("/scan", odd, rospy.Time(2))
    assert replay(tmp_path / "odd.bag", "none") == 1
    assert "none of the 1 scans on /scan can be placed" in capsys.readouterr().err


def test_a_connection_that_is_not_there_is_said_in_one_line(bag, capsys):
    content = bag.read_bytes()
    last = content.rindex(b"op=\x02")  # a message's record; rosbag writes conn before op
    at = content.rindex(b"conn=", 0, last) + len(b"conn=")
    bag.write_bytes(content[:at] + (3145729).to_bytes(4, "little") + content[at + 4:])
    assert replay(bag, "none") == 1
    said = capsys.readouterr().err
    assert "it names a connection 3145729 that it does not have" in said and said.count("\n") == 1


def test_a_bag_does_not_say_what_a_scan_is_made_of(tmp_path, capsys):
    md5sum = "0" * 32  # rosbag has no class for it yet
    header = {"topic": "/scan", "type": LaserScan._type, "md5sum": md5sum,
              "message_definition": "float32 x"}
    whole = io.BytesIO()
    scan_at(0.0, rospy.Time(1)).serialize(whole)
    raw = (LaserScan._type, whole.getvalue(), md5sum, LaserScan)
    with rosbag.Bag(str(tmp_path / "own.bag"), "w") as out:
        out.write("/scan", raw, rospy.Time(1), raw=True, connection_header=header)
    assert replay(tmp_path / "own.bag", "none") == 1
    assert "none of the 1 scans on /scan can be placed" in capsys.readouterr().err


def test_a_fault_of_ours_is_not_taken_for_one_of_the_bag(bag, monkeypatch):
    def fail(*_):
        raise ValueError("shapes do not fit")

    monkeypatch.setattr("gmapping.mapper.Mapper.take", fail)
    with pytest.raises(ValueError, match="shapes do not fit"):
        replay(bag, "none")


def test_what_is_no_bag_is_said_in_one_line(tmp_path, capsys):
    (tmp_path / "text.bag").write_text("no bag")
    assert main([str(tmp_path / "text.bag")]) == 1
    assert main([str(tmp_path / "missing.bag")]) == 1
    assert capsys.readouterr().err.count("\n") == 2
