"""Every number that any plugin asks for: the first one in the tag counts, with one warning."""

import pytest

from bullet_sim.plugin_tags import PluginParameters
from bullet_sim_ros.plugin_host import registry
from bullet_sim_ros.plugins import register_plugins

register_plugins()

CAMERA = ("<camera><image><width>4</width><height>4</height></image><clip><near>0.1</near><far>9"
          "</far></clip></camera>")
PAIR = "".join(CAMERA.replace("<camera>", f'<camera name="{side}">') for side in ("left", "right"))
RAY = "<ray><scan><horizontal><samples>3</samples></horizontal></scan></ray>"
SENSORS = {  # type of the sensor that a plugin belongs in, and what is in it
    "libgazebo_ros_camera.so": ("camera", CAMERA),
    "libgazebo_ros_triggered_camera.so": ("camera", CAMERA),
    "libgazebo_ros_multicamera.so": ("multicamera", PAIR),
    "libgazebo_ros_triggered_multicamera.so": ("multicamera", PAIR),
    "libgazebo_ros_openni_kinect.so": ("depth", CAMERA),
    "libgazebo_ros_depth_camera.so": ("depth", CAMERA),
    "libgazebo_ros_prosilica.so": ("camera", CAMERA),
    "libgazebo_ros_laser.so": ("ray", RAY),
    "libgazebo_ros_gpu_laser.so": ("gpu_ray", RAY),
    "libgazebo_ros_block_laser.so": ("ray", RAY),
    "libgazebo_ros_range.so": ("ray", RAY),
    "libgazebo_ros_velodyne_laser.so": ("ray", RAY),
    "libgazebo_ros_velodyne_gpu_laser.so": ("gpu_ray", RAY),
    "libhector_gazebo_ros_sonar.so": ("ray", RAY),
    "libgazebo_ros_imu_sensor.so": ("imu", ""),
    "libgazebo_ros_bumper.so": ("contact", "<contact><collision>c</collision></contact>"),
}
NEEDS = {  # the tags without which a plugin does not load
    "libgazebo_ros_diff_drive.so": "<leftJoint>j1</leftJoint><rightJoint>j2</rightJoint>",
    "libgazebo_ros_skid_steer_drive.so": "".join(
        f"<{side}Joint>j{number}</{side}Joint>" for number, side in enumerate(
            ("leftFront", "rightFront", "leftRear", "rightRear"), 1)),
    "libgazebo_ros_tricycle_drive.so": "".join(
        f"<{joint}Joint>j{number}</{joint}Joint>" for number, joint in enumerate(
            ("steering", "actuatedWheel"), 1)) + "<encoderWheelLeftJoint>j3</encoderWheelLeftJoint>"
        "<encoderWheelRightJoint>j4</encoderWheelRightJoint>",
    "libgazebo_ros_kobuki.so": "<left_wheel_joint_name>j1</left_wheel_joint_name>"
        "<right_wheel_joint_name>j2</right_wheel_joint_name><wheel_separation>1</wheel_separation>"
        "<wheel_diameter>1</wheel_diameter><torque>1</torque><velocity_command_timeout>1"
        "</velocity_command_timeout><cliff_detection_threshold>1</cliff_detection_threshold>"
        "<imu_name>imu</imu_name><bumper_name>contact</bumper_name>" + "".join(
            f"<cliff_sensor_{side}_name>ray</cliff_sensor_{side}_name>"
            for side in ("left", "center", "right")),
    "libgazebo_ros_elevator.so": "<topic>t</topic><lift_joint>j1</lift_joint>"
        "<door_joint>j2</door_joint>",
    "libgazebo_ros_harness.so": '<joint name="x"><child>base_footprint</child></joint>'
        "<detach>x</detach><winch><joint>x</joint></winch>",
    "libgazebo_ros_hand_of_god.so": "<linkName>base_footprint</linkName>",
    "libgazebo_ros_wheel_slip.so": '<wheel link_name="w1"/>',
    "libWheelSlipPlugin.so": '<wheel link_name="w1"/>',
    **dict.fromkeys(("libroboticsgroup_gazebo_mimic_joint_plugin.so",
                     "libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so",
                     "libgazebo_mimic_joint_plugin.so"),
                    "<joint>j1</joint><mimicJoint>j2</mimicJoint>"),
    **dict.fromkeys(("libroboticsgroup_gazebo_disable_link_plugin.so",
                     "libroboticsgroup_upatras_gazebo_disable_link_plugin.so"),
                    "<link>base_footprint</link>"),
    **dict.fromkeys(("libgazebo_grasp_fix.so", "libgazebo_grasp_plugin.so"),
                    "<palm_link>base_footprint</palm_link><gripper_link>w1</gripper_link>"),
    "libgazebo_ros_imu_sensor.so": "<frameName>base_footprint</frameName>",
    "libgazebo_ros_imu.so": "<bodyName>base_footprint</bodyName>",
    **dict.fromkeys(("libgazebo_ros_force.so", "libgazebo_ros_vacuum_gripper.so",
                     "libgazebo_ros_p3d.so", "libgazebo_ros_f3d.so"),
                    "<bodyName>base_footprint</bodyName><topicName>t</topicName>"),
    "libgazebo_ros_ft_sensor.so": "<jointName>j1</jointName><topicName>t</topicName>",
}
SHAPE = "<geometry><box><size>1 1 1</size></box></geometry>"
TEXT = " 1 0.5 0 7 m"


def robot(library: str, tags: str) -> str:
    """Four wheels, three sensors, and the plugin where it belongs."""
    plugin = f'<plugin name="p" filename="{library}">{tags}</plugin>'
    kind, inner = SENSORS.get(library, ("", ""))
    own = f'<sensor name="own" type="{kind}">{inner}{plugin}</sensor>' if kind else ""
    seen = plugin if library == "libgazebo_ros_video.so" else ""
    wheels = "".join(
        f'<link name="w{n}"/><joint name="j{n}" type="revolute"><parent>base_footprint</parent>'
        f"<child>w{n}</child><axis><xyz>0 1 0</xyz></axis></joint>" for n in range(1, 5))
    others = "".join(f'<sensor name="{name}" type="{name}">{inside}</sensor>' for name, inside in (
        ("imu", ""), ("ray", RAY), ("contact", "<contact><collision>c</collision></contact>")))
    return (f'<model name="bot"><link name="base_footprint"><collision name="c">{SHAPE}</collision>'
            f'<visual name="v">{SHAPE}{seen}</visual>{others}{own}</link>{wheels}'
            f"{'' if own or seen else plugin}</model>")


@pytest.fixture
def asked(monkeypatch) -> set[tuple[str, str]]:
    """The tags of which numbers were asked, each with the tags around it."""
    found = set()
    read = PluginParameters._numbers

    def recorded(self, tag, *others):
        found.add((*self._path, tag))
        return read(self, tag, *others)

    monkeypatch.setattr(PluginParameters, "_numbers", recorded)
    return found


@pytest.mark.parametrize("library", sorted(registry._registry))
def test_the_first_number_wins_for_every_plugins_every_tag(bench, caplog, asked, library):
    bench.spawn(robot(library, NEEDS.get(library, "")))
    assert "is not loaded" not in caplog.text
    bench.delete("bot")
    for path in sorted(asked):
        caplog.clear()
        opened = "".join(f"<{tag}>" for tag in path)
        closed = "".join(f"</{tag}>" for tag in reversed(path))
        bench.spawn(robot(library, opened + TEXT + closed + NEEDS.get(library, "")))
        assert "is not loaded" not in caplog.text
        said = [line for line in caplog.messages if "as Gazebo reads it" in line]
        assert len(said) == 1
        assert f"plugin p: {opened} is '1 0.5 0 7 m'; 1" in said[0]
        bench.delete("bot")
