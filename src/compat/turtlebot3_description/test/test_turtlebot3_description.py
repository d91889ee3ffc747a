"""The three robots against upstream's published numbers, and their meshes."""

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.files import expand

PACKAGE = Path(__file__).resolve().parent.parent
sys.path.append(str(PACKAGE.parents[2] / "tools/makers"))
import turtlebot3_meshes  # noqa: E402

MODELS = ("burger", "waffle", "waffle_pi")
WAFFLES = ("waffle", "waffle_pi")
MESH_BUDGET_BYTES = 400_000
WAFFLE_BUDGET_TRIANGLES = 3000

# joint: models, type, parent, child, x y z (m), roll pitch yaw (rad)
WHEEL, OPTICAL = (-1.57, 0, 0), (-1.57, 0, -1.57)
JOINTS = [
    ("base_joint", MODELS, "fixed", "base_footprint", "base_link", (0, 0, 0.010), (0, 0, 0)),
    ("wheel_left_joint", ("burger",), "continuous", "base_link", "wheel_left_link",
     (0, 0.08, 0.023), WHEEL),
    ("wheel_right_joint", ("burger",), "continuous", "base_link", "wheel_right_link",
     (0, -0.08, 0.023), WHEEL),
    ("wheel_left_joint", WAFFLES, "continuous", "base_link", "wheel_left_link",
     (0, 0.144, 0.023), WHEEL),
    ("wheel_right_joint", WAFFLES, "continuous", "base_link", "wheel_right_link",
     (0, -0.144, 0.023), WHEEL),
    ("caster_back_joint", ("burger",), "fixed", "base_link", "caster_back_link",
     (-0.081, 0, -0.004), WHEEL),
    ("caster_back_right_joint", WAFFLES, "fixed", "base_link", "caster_back_right_link",
     (-0.177, -0.064, -0.004), WHEEL),
    ("caster_back_left_joint", WAFFLES, "fixed", "base_link", "caster_back_left_link",
     (-0.177, 0.064, -0.004), WHEEL),
    ("imu_joint", ("burger",), "fixed", "base_link", "imu_link", (-0.032, 0, 0.068), (0, 0, 0)),
    ("imu_joint", WAFFLES, "fixed", "base_link", "imu_link", (0, 0, 0.068), (0, 0, 0)),
    ("scan_joint", ("burger",), "fixed", "base_link", "base_scan", (-0.032, 0, 0.172), (0, 0, 0)),
    ("scan_joint", WAFFLES, "fixed", "base_link", "base_scan", (-0.064, 0, 0.122), (0, 0, 0)),
    ("camera_joint", ("waffle",), "fixed", "base_link", "camera_link",
     (0.064, -0.065, 0.094), (0, 0, 0)),
    ("camera_joint", ("waffle_pi",), "fixed", "base_link", "camera_link",
     (0.073, -0.011, 0.084), (0, 0, 0)),
    ("camera_rgb_joint", ("waffle",), "fixed", "camera_link", "camera_rgb_frame",
     (0.005, 0.018, 0.013), (0, 0, 0)),
    ("camera_rgb_joint", ("waffle_pi",), "fixed", "camera_link", "camera_rgb_frame",
     (0.003, 0.011, 0.009), (0, 0, 0)),
    ("camera_rgb_optical_joint", WAFFLES, "fixed", "camera_rgb_frame", "camera_rgb_optical_frame",
     (0, 0, 0), OPTICAL),
    ("camera_depth_joint", ("waffle",), "fixed", "camera_link", "camera_depth_frame",
     (0.005, 0.028, 0.013), (0, 0, 0)),
    ("camera_depth_optical_joint", ("waffle",), "fixed", "camera_depth_frame",
     "camera_depth_optical_frame", (0, 0, 0), OPTICAL),
]

# link: models, mass (kg) or None, collision shape, its numbers (m), its origin (m)
LINKS = [
    ("base_footprint", MODELS, None, None, None, None),
    ("base_link", ("burger",), 0.82573504, "box", (0.140, 0.140, 0.143), (-0.032, 0, 0.070)),
    ("base_link", WAFFLES, 1.3729096, "box", (0.266, 0.266, 0.094), (-0.064, 0, 0.047)),
    ("wheel_left_link", MODELS, 0.02849894, "cylinder", (0.033, 0.018), (0, 0, 0)),
    ("wheel_right_link", MODELS, 0.02849894, "cylinder", (0.033, 0.018), (0, 0, 0)),
    ("caster_back_link", ("burger",), 0.005, "box", (0.030, 0.009, 0.020), (0, 0.001, 0)),
    ("caster_back_left_link", WAFFLES, 0.005, "box", (0.030, 0.009, 0.020), (0, 0.001, 0)),
    ("caster_back_right_link", WAFFLES, 0.005, "box", (0.030, 0.009, 0.020), (0, 0.001, 0)),
    ("imu_link", MODELS, None, None, None, None),
    ("base_scan", MODELS, 0.114, "cylinder", (0.055, 0.0315), (0.015, 0, -0.0065)),
    ("camera_link", ("waffle",), 0.564, "box", (0.012, 0.132, 0.020), (0.003, 0.065, 0.007)),
    ("camera_link", ("waffle_pi",), None, "box", (0.015, 0.030, 0.027), (0.005, 0.011, 0.013)),
    ("camera_rgb_frame", WAFFLES, None, None, None, None),
    ("camera_rgb_optical_frame", WAFFLES, None, None, None, None),
    ("camera_depth_frame", ("waffle",), None, None, None, None),
    ("camera_depth_optical_frame", ("waffle",), None, None, None, None),
]

MASSES = {"burger": 1.001733, "waffle": 2.117908, "waffle_pi": 1.553908}  # kg
MESHES = {
    "base_link": "bases/{}_base.stl", "wheel_left_link": "wheels/left_tire.stl",
    "wheel_right_link": "wheels/right_tire.stl", "base_scan": "sensors/lds.stl",
}
VISUAL_X = {"burger": -0.032, "waffle": -0.064, "waffle_pi": -0.064}  # m, of the base mesh

DRIVE = {
    "commandTopic": "cmd_vel", "odometryTopic": "odom", "odometryFrame": "odom",
    "odometrySource": "world", "publishOdomTF": "true", "publishTf": "true",
    "robotBaseFrame": "base_footprint", "publishWheelTF": "false",
    "publishWheelJointState": "true", "legacyMode": "false", "rosDebugLevel": "na",
    "updateRate": "30", "leftJoint": "wheel_left_joint", "rightJoint": "wheel_right_joint",
    "wheelDiameter": "0.066", "wheelAcceleration": "1", "wheelTorque": "10",
}
IMU = {
    "alwaysOn": "true", "bodyName": "imu_link", "frameName": "imu_link", "topicName": "imu",
    "serviceName": "imu_service", "gaussianNoise": "0.0", "updateRate": "0",
}
LASER = {
    "update_rate": 5, "ray/scan/horizontal/samples": 360, "ray/scan/horizontal/resolution": 1,
    "ray/scan/horizontal/min_angle": 0, "ray/scan/horizontal/max_angle": 6.28319,
    "ray/range/min": 0.120, "ray/range/max": 3.5, "ray/range/resolution": 0.015,
    "ray/noise/mean": 0, "ray/noise/stddev": 0.01,
}
CAMERAS = {
    "waffle": ("depth", "realsense_R200", "libgazebo_ros_openni_kinect.so", 1920, 1080, 1.3439),
    "waffle_pi": ("camera", "Pi Camera", "libgazebo_ros_camera.so", 640, 480, 1.085595),
}
CAMERA_PLUGIN = {
    "cameraName": "camera", "frameName": "camera_rgb_optical_frame", "updateRate": "30.0",
    "imageTopicName": "rgb/image_raw", "cameraInfoTopicName": "rgb/camera_info",
    "hackBaseline": "0.07",
}
DEPTH_PLUGIN = {
    "depthImageTopicName": "depth/image_raw", "pointCloudTopicName": "depth/points",
    "depthImageCameraInfoTopicName": "depth/camera_info", "pointCloudCutoff": "0.4",
}
WHEEL_SURFACE = {"mu1": 0.1, "mu2": 0.1, "kp": 5e5, "kd": 10, "minDepth": 0.001, "maxVel": 0.1}
CASTER_SURFACE = {"mu1": 0.1, "mu2": 0.1, "kp": 1e6, "kd": 100, "minDepth": 0.001, "maxVel": 1}


def xacro_path(model):
    return PACKAGE / "urdf" / f"turtlebot3_{model}.urdf.xacro"


@pytest.fixture(scope="module")
def robots():
    return {model: ElementTree.fromstring(expand(xacro_path(model))) for model in MODELS}


def numbers(text):
    return tuple(float(word) for word in text.split())


def shape_numbers(shape):
    if shape.tag == "box":
        return numbers(shape.get("size"))
    return float(shape.get("radius")), float(shape.get("length"))


def tags(element, names):
    return {name: element.findtext(name) for name in names}


def reference(robot, link):
    return [block for block in robot.findall("gazebo") if block.get("reference") == link]


def plugin(robot, filename):
    (found,) = (each for each in robot.iter("plugin") if each.get("filename") == filename)
    return found


def origin(robot, joint):
    element = robot.find(f"joint[@name='{joint}']/origin")
    return np.array(numbers(element.get("xyz")))


def stl_corners(path):
    """(n, 3, 3) corners in the file's own unit."""
    data = path.read_bytes()
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records = np.frombuffer(data, record, offset=84)
    assert len(records) == int.from_bytes(data[80:84], "little")
    return records["corners"]


@pytest.mark.parametrize("model", MODELS)
def test_names_are_those_of_the_tables(robots, model):
    assert robots[model].get("name") == f"turtlebot3_{model}"
    for tag, table in (("link", LINKS), ("joint", JOINTS)):
        named = [each.get("name") for each in robots[model].findall(tag)]
        assert sorted(named) == sorted(row[0] for row in table if model in row[1])


@pytest.mark.parametrize("model, row", [(model, row) for row in JOINTS for model in row[1]])
def test_joint(robots, model, row):
    name, _, kind, parent, child, xyz, rpy = row
    joint = robots[model].find(f"joint[@name='{name}']")
    assert joint.get("type") == kind
    assert joint.find("parent").get("link") == parent
    assert joint.find("child").get("link") == child
    assert numbers(joint.find("origin").get("xyz")) == xyz
    assert numbers(joint.find("origin").get("rpy")) == rpy
    axis = joint.find("axis")
    assert (axis is None) == (kind == "fixed")
    assert axis is None or numbers(axis.get("xyz")) == (0, 0, 1)


@pytest.mark.parametrize("model, row", [(model, row) for row in LINKS for model in row[1]])
def test_link(robots, model, row):
    name, _, mass, shape, size, centre = row
    link = robots[model].find(f"link[@name='{name}']")
    found = link.find("inertial/mass")
    assert (None if found is None else float(found.get("value"))) == mass
    collision = link.find("collision")
    assert (collision is None) == (shape is None)
    if shape:
        (geometry,) = collision.find("geometry")
        assert (geometry.tag, shape_numbers(geometry)) == (shape, size)
        assert numbers(collision.find("origin").get("xyz")) == centre


@pytest.mark.parametrize("model", MODELS)
def test_masses_add_up(robots, model):
    masses = [float(mass.get("value")) for mass in robots[model].iter("mass")]
    assert sum(masses) == pytest.approx(MASSES[model], abs=1e-6)


@pytest.mark.parametrize("model", MODELS)
def test_inertia_is_that_of_the_collision_solid(robots, model):
    for link in robots[model].findall("link[inertial]"):
        mass = float(link.find("inertial/mass").get("value"))
        inertia = link.find("inertial/inertia")
        (shape,) = link.find("collision/geometry")
        if shape.tag == "box":
            x, y, z = shape_numbers(shape)
            expected = [mass / 12 * (p**2 + q**2) for p, q in ((y, z), (x, z), (x, y))]
        else:
            radius, length = shape_numbers(shape)
            across = mass * (radius**2 / 4 + length**2 / 12)
            expected = [across, across, mass * radius**2 / 2]
        found = [float(inertia.get(axis)) for axis in ("ixx", "iyy", "izz")]
        assert found == pytest.approx(expected, rel=1e-9), link.get("name")


@pytest.mark.parametrize("model", MODELS)
def test_drive_and_imu(robots, model):
    drive = plugin(robots[model], "libgazebo_ros_diff_drive.so")
    assert drive.get("name") == f"turtlebot3_{model}_controller"
    assert tags(drive, DRIVE) == DRIVE
    separation = 0.160 if model == "burger" else 0.287
    assert float(drive.findtext("wheelSeparation")) == separation
    imu = plugin(robots[model], "libgazebo_ros_imu.so")
    assert imu.get("name") == "imu_plugin"
    assert tags(imu, IMU) == IMU
    (block,) = reference(robots[model], "imu_link")
    sensor = block.find("sensor[@type='imu'][@name='imu']")
    assert sensor.findtext("always_on") == "true" and sensor.find("plugin") is None


@pytest.mark.parametrize("model", MODELS)
def test_laser(robots, model):
    (block,) = reference(robots[model], "base_scan")
    assert block.findtext("material") == "Gazebo/FlatBlack"
    sensor = block.find("sensor[@type='ray'][@name='lds_lfcd_sensor']")
    assert {place: float(sensor.findtext(place)) for place in LASER} == LASER
    assert sensor.findtext("ray/noise/type") == "gaussian"
    laser = plugin(robots[model], "libgazebo_ros_laser.so")
    assert (laser.findtext("topicName"), laser.findtext("frameName")) == ("scan", "base_scan")


@pytest.mark.parametrize("model", CAMERAS)
def test_camera(robots, model):
    kind, name, filename, width, height, fov = CAMERAS[model]
    (block,) = reference(robots[model], "camera_rgb_frame")
    sensor = block.find("sensor")
    assert (sensor.get("type"), sensor.get("name")) == (kind, name)
    assert sensor.find("update_rate") is None
    image = sensor.find("camera/image")
    assert tags(image, ("width", "height", "format")) == {
        "width": str(width), "height": str(height), "format": "R8G8B8"}
    assert float(sensor.findtext("camera/horizontal_fov")) == fov
    assert numbers(" ".join(sensor.find("camera/clip").itertext())) == (0.03, 100)
    expected = {**CAMERA_PLUGIN, **(DEPTH_PLUGIN if kind == "depth" else {})}
    assert tags(plugin(robots[model], filename), expected) == expected


def image_size(model, **arguments):
    robot = ElementTree.fromstring(expand(xacro_path(model), arguments))
    image = robot.find(".//camera/image")
    return image.findtext("width"), image.findtext("height")


@pytest.mark.parametrize("model", CAMERAS)
def test_arguments_set_the_cameras_size(model):
    own = tuple(map(str, CAMERAS[model][3:5]))
    assert image_size(model, camera_width="320", camera_height="200") == ("320", "200")
    assert image_size(model, camera_width="320") == ("320", own[1])
    assert image_size(model, camera_width="", camera_height="") == own


@pytest.mark.parametrize("size", ["0", "-5", "wide", "64.5", "1e3", "6 4", "True"])
@pytest.mark.parametrize("argument", ["camera_width", "camera_height"])
def test_a_wrong_camera_size_is_one_clear_error(argument, size):
    with pytest.raises(FormatError) as raised:
        expand(xacro_path("waffle"), {argument: size})
    said = str(raised.value)
    assert f"{argument} is " in said and "a whole number of pixels, 1 or more" in said
    assert "\n" not in said


@pytest.mark.parametrize("model", MODELS)
def test_surfaces(robots, model):
    robot = robots[model]
    (base,) = reference(robot, "base_link")
    assert base.findtext("material") == "Gazebo/DarkGrey"
    for link in (each.get("name") for each in robot.findall("link")):
        expected = next((surface for start, surface in (
            ("wheel", WHEEL_SURFACE), ("caster", CASTER_SURFACE)) if link.startswith(start)), None)
        if expected:
            (block,) = reference(robot, link)
            assert {tag: float(block.findtext(tag)) for tag in expected} == expected
            assert block.findtext("material") == "Gazebo/FlatBlack"
            assert block.findtext("fdir1") == ("1 0 0" if link.startswith("wheel") else None)


@pytest.mark.parametrize("model", MODELS)
def test_arguments_switch_the_sensor_visuals(model):
    for argument, sensor in (("laser_visual", "lds_lfcd_sensor"), ("imu_visual", "imu")):
        robot = ElementTree.fromstring(expand(xacro_path(model), {argument: "true"}))
        shown = {each.get("name"): each.findtext("visualize") for each in robot.iter("sensor")}
        assert [name for name, visible in shown.items() if visible == "true"] == [sensor]


@pytest.mark.parametrize("model", MODELS)
def test_urdfdom_reads_it(model, tmp_path):
    urdf = tmp_path / f"{model}.urdf"
    urdf.write_text(expand(xacro_path(model)))
    subprocess.run(["check_urdf", str(urdf)], check=True, capture_output=True)


@pytest.mark.parametrize("model", MODELS)
def test_meshes_are_where_the_urdf_says(robots, model):
    expected = {link: place.format(model) for link, place in MESHES.items()}
    if model == "waffle":
        expected["camera_link"] = "sensors/r200.dae"
    found = {}
    for link in robots[model].findall("link[visual]"):
        mesh = link.find("visual/geometry/mesh")
        package, found[link.get("name")] = mesh.get("filename").split("/meshes/")
        assert package == "package://turtlebot3_description"
        in_metres = mesh.get("filename").endswith(".dae")
        assert mesh.get("scale") == (None if in_metres else "0.001 0.001 0.001")
        assert (PACKAGE / "meshes" / found[link.get("name")]).is_file()
    assert found == expected
    assert origin_of_base_visual(robots[model]) == (VISUAL_X[model], 0, 0)


def origin_of_base_visual(robot):
    return numbers(robot.find("link[@name='base_link']/visual/origin").get("xyz"))


def test_the_meshes_are_small():
    meshes = (path for path in (PACKAGE / "meshes").rglob("*") if path.is_file())
    assert sum(path.stat().st_size for path in meshes) < MESH_BUDGET_BYTES


def test_solids_face_outwards():
    made = turtlebot3_meshes
    robots = made.waffle_pi() + made.burger() + made.lds() + made.tire(1)
    for solid in robots + made.tire(-1):
        a, b, c = np.moveaxis(solid - solid.mean(axis=(0, 1)), 1, 0)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0


def test_waffle_is_quick_to_draw():
    meshes = [PACKAGE / "meshes" / place.format("waffle") for place in MESHES.values()]
    triangles = sum(len(stl_corners(mesh)) for mesh in meshes)
    camera = ElementTree.parse(PACKAGE / "meshes/sensors/r200.dae")
    triangles += sum(int(each.get("count")) for each in camera.iter("{*}triangles"))
    assert triangles < WAFFLE_BUDGET_TRIANGLES


@pytest.mark.parametrize("model", CAMERAS)
def test_nothing_stands_before_the_camera(robots, model):
    robot = robots[model]
    camera_x = (origin(robot, "camera_joint") + origin(robot, "camera_rgb_joint"))[0]
    base_x = stl_corners(PACKAGE / f"meshes/bases/{model}_base.stl")[..., 0].max() * 0.001
    wheel_x = stl_corners(PACKAGE / "meshes/wheels/left_tire.stl")[..., 0].max() * 0.001
    laser_x = stl_corners(PACKAGE / "meshes/sensors/lds.stl")[..., 0].max() * 0.001
    laser_x += origin(robot, "scan_joint")[0]
    assert max(base_x + VISUAL_X[model], wheel_x, laser_x) < camera_x
    if model == "waffle":  # z of the bar's mesh points forward, from camera_link
        text = ElementTree.parse(PACKAGE / "meshes/sensors/r200.dae").findtext(".//{*}float_array")
        bar_x = np.array(numbers(text)).reshape(-1, 3)[:, 2].max()
        assert bar_x < origin(robot, "camera_rgb_joint")[0]
