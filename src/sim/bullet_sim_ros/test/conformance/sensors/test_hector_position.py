"""hector_gazebo's GPS and magnetometer, and SDF's <spherical_coordinates>."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Vector3Stamped
from sensor_models import EARTH, hector, take, xyz
from sensor_msgs.msg import MagneticField, NavSatFix, NavSatStatus

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist

DEGREE = 111_412.0  # m, of latitude at 60 degrees north on WGS84
PARALLEL = 55_800.0  # m, of longitude there


def test_gps_of_another_link(bench):
    # conforms: libhector_gazebo_ros_gps.so/bodyName
    fix = take(bench, "/fix", hector("gps", "<bodyName>mast</bodyName>"))[-1]
    assert fix.altitude == 2.0


def test_gps_in_darmstadt(bench):
    # conforms: libhector_gazebo_ros_gps.so
    fix = take(bench, "/fix", hector("gps"), pose=Pose((0, 0, 3)))[-1]
    assert isinstance(fix, NavSatFix)
    assert (fix.latitude, fix.longitude, fix.altitude) == (49.9, 8.9, 3.0)
    assert (fix.status.status, fix.status.service) == (NavSatStatus.STATUS_FIX, 0)
    assert fix.position_covariance_type == NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN
    assert not any(fix.position_covariance)


def test_gps_references(bench):
    # conforms: libhector_gazebo_ros_gps.so/referenceLatitude
    # conforms: libhector_gazebo_ros_gps.so/referenceLongitude
    # conforms: libhector_gazebo_ros_gps.so/referenceAltitude
    # conforms: libhector_gazebo_ros_gps.so/referenceHeading, libhector_gazebo_ros_gps.so/status
    # conforms: libhector_gazebo_ros_gps.so/service
    tags = """<referenceLatitude>60</referenceLatitude><referenceLongitude>10</referenceLongitude>
      <referenceAltitude>50</referenceAltitude><referenceHeading>90</referenceHeading>
      <status>2</status><service>5</service>"""
    fix = take(bench, "/fix", hector("gps", tags), pose=Pose((200, 100, 3)))[-1]
    assert (fix.latitude - 60) * DEGREE == pytest.approx(100, rel=1e-3)  # x east, y north
    assert (fix.longitude - 10) * PARALLEL == pytest.approx(200, rel=1e-3)
    assert fix.altitude == 53
    assert (fix.status.status, fix.status.service) == (2, 5)


@pytest.mark.parametrize("tag, north, east", [
    ("", 100, 200), ("<useWorldSphericalCoordinates>true</useWorldSphericalCoordinates>", 100, 200),
    ("<referenceHeading>0</referenceHeading>", 200, -100)])
def test_gps_of_a_world_that_is_on_earth(make_bench, tag, north, east):
    # conforms: sdf world/spherical_coordinates, sdf world/spherical_coordinates/latitude_deg
    # conforms: sdf world/spherical_coordinates/longitude_deg
    # conforms: sdf world/spherical_coordinates/elevation
    # conforms: libhector_gazebo_ros_gps.so/useWorldSphericalCoordinates
    bench = make_bench(EARTH.format(heading=0))
    fix = take(bench, "/fix", hector("gps", tag), pose=Pose((200, 100, 3)))[-1]
    assert (fix.latitude - 60) * DEGREE == pytest.approx(north, rel=1e-3)
    assert (fix.longitude - 10) * PARALLEL == pytest.approx(east, rel=1e-3)
    assert fix.altitude == 53


def test_a_world_that_is_turned_and_not_used(make_bench):
    # conforms: sdf world/spherical_coordinates/heading_deg
    # conforms: libhector_gazebo_ros_gps.so/useWorldSphericalCoordinates
    bench = make_bench(EARTH.format(heading=90))  # x to the north
    fix = take(bench, "/fix", hector("gps"), pose=Pose((200, 100, 3)))[-1]
    assert (fix.latitude - 60) * DEGREE == pytest.approx(200, rel=1e-3)
    bench.delete("bot")
    tag = "<useWorldSphericalCoordinates>false</useWorldSphericalCoordinates>"
    assert take(bench, "/fix", hector("gps", tag))[-1].latitude == 49.9


def test_velocity_is_north_west_up(bench):
    # conforms: libhector_gazebo_ros_gps.so/velocityTopicName
    text = """<model name="bot"><link name="base"><inertial><mass>1</mass></inertial>
      <gravity>false</gravity></link><plugin name="p" filename="libhector_gazebo_ros_gps.so">
      <velocityTopicName>speed</velocityTopicName><referenceHeading>90</referenceHeading>
      </plugin></model>"""
    bench.spawn(text, Pose((0, 0, 9))).set_twist(Twist((3, 1, 2)))
    speeds = bench.listen("/speed")
    bench.run(0.3)
    assert isinstance(speeds[0], Vector3Stamped)
    assert xyz(speeds[0].vector) == pytest.approx([1, -3, 2], abs=1e-3)


def test_errors_of_the_position(bench):
    # conforms: libhector_gazebo_ros_gps.so/offset, libhector_gazebo_ros_gps.so/gaussianNoise
    # conforms: libhector_gazebo_ros_gps.so/drift, libhector_gazebo_ros_gps.so/driftFrequency
    # conforms: libhector_gazebo_ros_gps.so/scaleError
    def altitudes(tags: str, seconds: float = 0.3) -> np.ndarray:
        fixes = take(bench, "/fix", hector("gps", f"{tags}<updateRate>0</updateRate>"), seconds,
                     Pose((0, 0, 10)))
        bench.delete("bot")
        covariance = fixes[-1].position_covariance
        assert covariance[0] == pytest.approx(0.25 if "drift>" in tags else
                                              1 if "Noise" in tags else 0)
        return np.array([fix.altitude for fix in fixes])

    assert altitudes("<offset>0 0 2</offset>")[-1] == pytest.approx(12)
    assert altitudes("<scaleError>1 1 0.5</scaleError>")[-1] == pytest.approx(5)
    assert altitudes("<gaussianNoise>1</gaussianNoise>", 0.5).std() == pytest.approx(1, rel=0.15)
    quick = altitudes("<drift>0.5</drift><driftFrequency>50</driftFrequency>", 2.0)
    assert quick.std() == pytest.approx(0.5, rel=0.4)


def test_a_drifting_velocity_carries_the_position_away(bench):
    # conforms: libhector_gazebo_ros_gps.so/velocityDrift
    bench.spawn(hector("gps", "<velocityDrift>0 0 5</velocityDrift><updateRate>100</updateRate>"))
    fixes, speeds = bench.listen("/fix"), bench.listen("/fix_velocity")
    bench.run(2.0)
    way = fixes[-1].altitude - fixes[0].altitude
    assert way == pytest.approx(np.mean([s.vector.z for s in speeds]) * 2.0, rel=0.1)
    assert abs(way) > 0.1


def test_the_magnetic_field(bench):
    # conforms: libhector_gazebo_ros_magnetic.so, libhector_gazebo_ros_magnetic.so/magnitude
    # conforms: libhector_gazebo_ros_magnetic.so/inclination
    # conforms: libhector_gazebo_ros_magnetic.so/declination
    # conforms: libhector_gazebo_ros_magnetic.so/referenceHeading
    plain = take(bench, "/magnetic", hector("magnetic"))[-1]
    assert isinstance(plain, Vector3Stamped)
    assert xyz(plain.vector) == pytest.approx([0.5, 0, -math.sqrt(0.75)])
    bench.delete("bot")
    tags = """<magnitude>2</magnitude><inclination>30</inclination><declination>10</declination>
      <referenceHeading>100</referenceHeading>"""
    told = take(bench, "/magnetic", hector("magnetic", tags))[-1]
    assert xyz(told.vector) == pytest.approx([0, 2 * math.cos(math.pi / 6), -1], abs=1e-9)


def test_the_field_is_in_the_links_axes(bench):
    # conforms: libhector_gazebo_ros_magnetic.so
    pose = Pose.from_xyz_rpy((0, 0, 0), (0, 0, math.pi / 2))
    told = take(bench, "/magnetic", hector("magnetic"), pose=pose)[-1]
    assert xyz(told.vector) == pytest.approx([0, -0.5, -math.sqrt(0.75)], abs=1e-6)


def test_the_fields_message_and_a_world_on_earth(make_bench):
    # conforms: libhector_gazebo_ros_magnetic.so/useMagneticFieldMsgs
    # conforms: libhector_gazebo_ros_magnetic.so/useWorldSphericalCoordinates
    bench = make_bench(EARTH.format(heading=0))
    tags = "<useMagneticFieldMsgs>true</useMagneticFieldMsgs>"
    told = take(bench, "/magnetic", hector("magnetic", tags))[-1]
    assert isinstance(told, MagneticField)
    assert xyz(told.magnetic_field) == pytest.approx([0, 0.5, -math.sqrt(0.75)])  # y is north
    bench.delete("bot")
    tags = "<useWorldSphericalCoordinates>false</useWorldSphericalCoordinates>"
    other = take(bench, "/magnetic2", hector(
        "magnetic", f"{tags}<topicName>magnetic2</topicName>"))[-1]
    assert xyz(other.vector) == pytest.approx([0.5, 0, -math.sqrt(0.75)])
