"""hector_gazebo's sonar and barometer."""

import numpy as np
import pytest
from dynamic_reconfigure.msg import Config, DoubleParameter
from geometry_msgs.msg import PointStamped
from hector_uav_msgs.msg import Altimeter
from sensor_models import hector, take, xyz
from sensor_msgs.msg import Range

from bullet_sim.pose import Pose


def sonar(tags: str = "") -> str:
    return f"""<model name="bot"><static>true</static>
      <link name="l"><pose>0 0 2 0 1.5707963 0</pose>
      <sensor name="s" type="ray"><update_rate>40</update_rate><ray>
      <scan><horizontal><samples>3</samples><min_angle>-0.2</min_angle><max_angle>0.2</max_angle>
      </horizontal><vertical><samples>3</samples><min_angle>-0.1</min_angle>
      <max_angle>0.1</max_angle></vertical></scan>
      <range><min>0.5</min><max>3</max></range></ray>
      <plugin name="p" filename="libhector_gazebo_ros_sonar.so">{tags}</plugin></sensor></link>
      </model>"""


def test_sonar(bench):
    # conforms: libhector_gazebo_ros_sonar.so, libhector_gazebo_ros_sonar.so/updateRate
    ranges = take(bench, "/sonar", sonar(), 1.0)
    assert len(ranges) == 10
    last = ranges[-1]
    assert isinstance(last, Range)
    assert (last.header.frame_id, last.radiation_type) == ("sonar_link", Range.ULTRASOUND)
    assert last.range == pytest.approx(2.0, abs=1e-3)
    assert last.field_of_view == pytest.approx(0.2)
    assert (last.min_range, last.max_range) == (0.5, 3.0)


def test_tags_of_the_sonar(bench):
    # conforms: libhector_gazebo_ros_sonar.so/topicName, libhector_gazebo_ros_sonar.so/frameId
    # conforms: libhector_gazebo_ros_sonar.so/robotNamespace
    # conforms: libhector_gazebo_ros_sonar.so/updateRate, libhector_gazebo_ros_sonar.so/updatePeriod
    tags = """<topicName>down</topicName><frameId>belly</frameId><updateRate>20</updateRate>
      <robotNamespace>/r1</robotNamespace>"""
    ranges = take(bench, "/r1/down", sonar(tags), 1.0)
    assert (len(ranges), ranges[0].header.frame_id) == (20, "belly")
    bench.delete("bot")
    assert len(take(bench, "/sonar", sonar("<updatePeriod>0.2</updatePeriod>"), 1.0)) == 5


def test_errors_of_the_sonar_stay_within_its_range(bench):
    # conforms: libhector_gazebo_ros_sonar.so/offset, libhector_gazebo_ros_sonar.so/scaleError
    # conforms: libhector_gazebo_ros_sonar.so/gaussianNoise, libhector_gazebo_ros_sonar.so/drift
    # conforms: libhector_gazebo_ros_sonar.so/driftFrequency
    def told(tags: str, seconds: float = 0.5) -> np.ndarray:
        ranges = take(bench, "/sonar", sonar(f"{tags}<updateRate>0</updateRate>"), seconds)
        bench.delete("bot")
        return np.array([found.range for found in ranges])

    assert told("<offset>0.5</offset>", 0.01)[-1] == pytest.approx(2.5, abs=1e-3)
    assert told("<scaleError>0.5</scaleError>", 0.01)[-1] == pytest.approx(1.0, abs=1e-3)
    assert told("<gaussianNoise>0.1</gaussianNoise>").std() == pytest.approx(0.1, rel=0.2)
    wild = told("<gaussianNoise>9</gaussianNoise>")
    assert (wild.min(), wild.max()) == (0.5, 3.0)
    drifting = told("<drift>0.1</drift><driftFrequency>50</driftFrequency>", 1.0)
    assert drifting.std() == pytest.approx(0.1, rel=0.5)
    assert np.diff(drifting).std() < 0.05


def test_the_sonar_can_be_reconfigured(bench):
    # conforms: TOPIC/set_parameters of hector's sensors
    ranges = take(bench, "/sonar", sonar())
    bench.call("/sonar/set_parameters",
               config=Config(doubles=[DoubleParameter("scale_error", 0.5)]))
    bench.run(0.15)
    assert ranges[-1].range == pytest.approx(1.0, abs=1e-3)


def test_height_by_pressure(bench):
    # conforms: libhector_gazebo_ros_baro.so, libhector_gazebo_ros_baro.so/elevation
    # conforms: libhector_gazebo_ros_baro.so/qnh, libhector_gazebo_ros_baro.so/altimeterTopicName
    bench.spawn(hector("baro", """<elevation>1000</elevation><qnh>1000</qnh>
      <altimeterTopicName>alt</altimeterTopicName>"""), Pose((0, 0, 7)))
    heights, altimeters = bench.listen("/pressure_height"), bench.listen("/alt")
    bench.run(0.01)
    assert isinstance(heights[-1], PointStamped)
    assert xyz(heights[-1].point) == [0, 0, 7]
    told = altimeters[-1]
    assert isinstance(told, Altimeter)
    assert (told.altitude, told.qnh) == (1007, 1000)
    assert told.pressure == pytest.approx(1000 * (1 - 1007 / 44330) ** 5.263157)


def test_baro_by_default_and_without_topics(bench):
    # conforms: libhector_gazebo_ros_baro.so/qnh, libhector_gazebo_ros_baro.so/topicName
    # conforms: libhector_gazebo_ros_baro.so/altimeterTopicName
    told = take(bench, "/altimeter", hector("baro"), 0.01)[-1]
    assert (told.altitude, told.qnh) == (0, 1013.25)
    assert told.pressure == pytest.approx(1013.25)
    bench.delete("bot")
    before = set(bench.advertised())
    bench.spawn(hector("baro", "<topicName/><altimeterTopicName/>"))
    bench.run(0.01)
    assert set(bench.advertised()) == before
