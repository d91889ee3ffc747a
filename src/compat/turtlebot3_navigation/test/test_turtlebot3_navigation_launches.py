"""turtlebot3_slam and turtlebot3_navigation: upstream's names, arguments and values."""

import subprocess
import sys
from pathlib import Path

import pytest
import roslaunch.config
import roslaunch.xmlloader
import yaml

from map_server.map_files import read_map

COMPAT = Path(__file__).resolve().parents[2]
NAVIGATION, SLAM = COMPAT / "turtlebot3_navigation", COMPAT / "turtlebot3_slam"
OTHER_METHODS = ("cartographer", "karto", "frontier_exploration")
BURGER = [[-.105, -.105], [-.105, .105], [.041, .105], [.041, -.105]]
WAFFLE = [[-.205, -.155], [-.205, .155], [.077, .155], [.077, -.155]]
MODELS = {  # outline, largest and least speed, m/s; the same in rad/s; sim_time, s
    "burger": (BURGER, 0.22, 0.11, 2.75, 1.37, 1.5),
    "waffle": (WAFFLE, 0.26, 0.13, 1.82, 0.9, 2.0),
    "waffle_pi": (WAFFLE, 0.26, 0.13, 1.82, 0.9, 2.0),
}
GMAPPING = {
    "map_update_interval": 2.0, "maxUrange": 3.0, "sigma": .05, "kernelSize": 1, "lstep": .05,
    "astep": .05, "iterations": 5, "lsigma": .075, "ogain": 3.0, "lskip": 0, "minimumScore": 50,
    "srr": .1, "srt": .2, "str": .1, "stt": .2, "linearUpdate": 1.0, "angularUpdate": .2,
    "temporalUpdate": .5, "resampleThreshold": .5, "particles": 100, "xmin": -10, "ymin": -10,
    "xmax": 10, "ymax": 10, "delta": .05, "llsamplerange": .01, "llsamplestep": .01,
    "lasamplerange": .005, "lasamplestep": .005}
HECTOR = {
    "map_frame": "map", "odom_frame": "odom", "base_frame": "base_footprint", "scan_topic": "scan",
    "scan_subscriber_queue_size": 5, "pub_map_odom_transform": True, "map_size": 2048,
    "tf_map_scanmatch_transform_frame_name": "scanmatcher_frame", "map_resolution": 0.05,
    "map_update_distance_thresh": 0.1, "map_update_angle_thresh": 0.04, "map_pub_period": 2,
    "laser_min_dist": 0.12, "laser_max_dist": 3.5}
AMCL = {
    "min_particles": 500, "max_particles": 3000, "kld_err": .02, "update_min_d": .2,
    "update_min_a": .2, "resample_interval": 1, "transform_tolerance": .5,
    "recovery_alpha_slow": 0, "recovery_alpha_fast": 0, "gui_publish_rate": 50,
    "laser_max_range": 3.5, "laser_max_beams": 180, "laser_z_hit": .5, "laser_z_short": .05,
    "laser_z_max": .05, "laser_z_rand": .5, "laser_sigma_hit": .2, "laser_lambda_short": .1,
    "laser_likelihood_max_dist": 2.0, "laser_model_type": "likelihood_field",
    "odom_model_type": "diff", "odom_alpha1": .1, "odom_alpha2": .1, "odom_alpha3": .1,
    "odom_alpha4": .1, "odom_frame_id": "odom", "base_frame_id": "base_footprint",
    "initial_pose_x": 0.0, "initial_pose_y": 0.0, "initial_pose_a": 0.0}
MOVE_BASE = {
    "shutdown_costmaps": False, "controller_frequency": 10, "planner_patience": 5,
    "controller_patience": 15, "conservative_reset_dist": 3, "planner_frequency": 5,
    "oscillation_timeout": 10, "oscillation_distance": .2,
    "base_local_planner": "dwa_local_planner/DWAPlannerROS"}


def load(package, name, *arguments):
    config = roslaunch.config.ROSLaunchConfig()
    loader = roslaunch.xmlloader.XmlLoader()
    written = loader.param_value  # <param command> is not run: no robot is made
    loader.param_value = lambda *given: "a robot" if given[-1] is not None else written(*given)
    loader.load(str(package / "launch" / f"{name}.launch"), config, argv=list(arguments),
                verbose=False)
    nodes = {f"{node.namespace}{node.name}": node for node in config.nodes}
    return nodes, {key: param.value for key, param in config.params.items()}


def below(values, space):
    return {key[len(space):]: value for key, value in values.items() if key.startswith(space)}


@pytest.fixture(autouse=True)
def burger_without_a_screen(monkeypatch):
    monkeypatch.setenv("TURTLEBOT3_MODEL", "burger")
    monkeypatch.delenv("DISPLAY", raising=False)


def test_gmapping():
    nodes, values = load(SLAM, "turtlebot3_gmapping", "set_base_frame:=b", "set_map_frame:=m",
                         "set_odom_frame:=o")
    assert nodes["/turtlebot3_slam_gmapping"].type == "slam_gmapping"
    frames = {"base_frame": "b", "odom_frame": "o", "map_frame": "m"}
    assert below(values, "/turtlebot3_slam_gmapping/") == frames | GMAPPING
    _, values = load(SLAM, "turtlebot3_gmapping")
    assert values["/turtlebot3_slam_gmapping/base_frame"] == "base_footprint"


def test_slam():
    nodes, values = load(SLAM, "turtlebot3_slam", "slam_methods:=gmapping")
    assert {"/turtlebot3_slam_gmapping", "/robot_state_publisher", "/rviz"} == set(nodes)
    assert values["/robot_description"] == "a robot"
    assert "/rviz" not in load(SLAM, "turtlebot3_slam", "open_rviz:=false")[0]


def test_hector():
    nodes, values = load(SLAM, "turtlebot3_slam", "slam_methods:=hector")
    assert nodes["/hector_mapping"].type == "hector_mapping"
    assert below(values, "/hector_mapping/") == HECTOR
    assert load(SLAM, "turtlebot3_hector", "map_size:=512")[1]["/hector_mapping/map_size"] == 512


@pytest.mark.parametrize(("words", "method", "meant"), [
    *((["turtlebot3_slam.launch", f"slam_methods:={method}"], method, "gmapping")
      for method in (*OTHER_METHODS, "gmaping")),
    (["turtlebot3_slam.launch", "slam_methods:=hektor"], "hektor", "hector"),
    *(([f"turtlebot3_{method}.launch"], method, "gmapping") for method in OTHER_METHODS)])
def test_other_methods_end_with_1_and_say_what_to_type(words, method, meant):
    done = subprocess.run(["roslaunch", "--nodes", "turtlebot3_slam", *words], text=True,
                          capture_output=True, timeout=60)
    assert done.returncode == 1
    assert f"slam_methods:={method} is not here" in done.stderr
    assert "there are: gmapping, hector." in done.stderr and f"slam_methods:={meant}" in done.stderr


@pytest.mark.parametrize("package, name, config", [
    (SLAM, "turtlebot3_slam", "turtlebot3_gmapping"),
    (NAVIGATION, "turtlebot3_navigation", "turtlebot3_navigation")])
def test_rviz(package, name, config, monkeypatch):
    """Required as upstream's where there is a screen; else one line, and the rest goes on."""
    line = load(package, name)[0]["/rviz"]
    assert (line.package, line.type, line.required) == ("turtlebot3_bringup", "no_screen", False)
    done = subprocess.run([sys.executable, COMPAT / "turtlebot3_bringup" / "nodes" / line.type],
                          text=True, capture_output=True, timeout=60)
    assert done.returncode == 0 and len(done.stderr.splitlines()) == 1
    assert "DISPLAY" in done.stderr and "open_rviz:=false" in done.stderr
    assert "the other nodes do not need it" in done.stderr  # whether they run is not known here
    monkeypatch.setenv("DISPLAY", ":0")
    rviz = load(package, name)[0]["/rviz"]
    assert (rviz.package, rviz.required) == ("rviz", True)
    file = Path(rviz.args.split()[1])
    assert file.name == f"{config}.rviz"
    assert yaml.safe_load(file.read_text(encoding="utf-8"))["Visualization Manager"]


def test_navigation():
    nodes, values = load(NAVIGATION, "turtlebot3_navigation", "open_rviz:=false")
    assert set(nodes) == {"/robot_state_publisher", "/map_server", "/amcl", "/move_base"}
    assert nodes["/map_server"].args.endswith("/turtlebot3_navigation/maps/map.yaml")
    assert below(values, "/amcl/") == AMCL
    own = below(values, "/move_base/")
    assert {key: value for key, value in own.items() if "/" not in key} == MOVE_BASE
    moved, values = load(NAVIGATION, "turtlebot3_navigation", "open_rviz:=false", "map_file:=/m",
                         "initial_pose_x:=1.5", "move_forward_only:=true")
    assert moved["/map_server"].args == "/m"
    assert values["/amcl/initial_pose_x"] == 1.5
    assert values["/move_base/DWAPlannerROS/min_vel_x"] == 0.0


@pytest.mark.parametrize("model", MODELS)
def test_move_base(model):
    footprint, speed, least, turn, least_turn, sim_time = MODELS[model]
    nodes, values = load(NAVIGATION, "move_base", f"model:={model}")
    assert dict(nodes["/move_base"].remap_args) == {"cmd_vel": "/cmd_vel", "odom": "odom"}
    planner = below(values, "/move_base/DWAPlannerROS/")
    expected = {
        "max_vel_x": speed, "min_vel_x": -speed, "max_vel_trans": speed, "min_vel_trans": least,
        "max_vel_theta": turn, "min_vel_theta": least_turn, "acc_lim_x": 2.5, "acc_lim_y": 0,
        "acc_lim_theta": 3.2, "xy_goal_tolerance": .05, "yaw_goal_tolerance": .17,
        "sim_time": sim_time, "vx_samples": 20, "vy_samples": 0, "vth_samples": 40,
        "path_distance_bias": 32, "goal_distance_bias": 20, "occdist_scale": .02}
    assert {name: planner[name] for name in expected} == expected
    shared = {"obstacle_range": 3.0, "raytrace_range": 3.5, "inflation_radius": 1.0,
              "cost_scaling_factor": 3.0, "map_type": "costmap", "observation_sources": "scan",
              "footprint": footprint, "scan/sensor_frame": "base_scan", "scan/topic": "scan",
              "scan/data_type": "LaserScan", "scan/marking": True, "scan/clearing": True,
              "robot_base_frame": "base_footprint", "update_frequency": 10,
              "publish_frequency": 10, "transform_tolerance": .5}
    assert below(values, "/move_base/global_costmap/") == shared | {
        "global_frame": "map", "static_map": True}
    assert below(values, "/move_base/local_costmap/") == shared | {
        "global_frame": "odom", "static_map": False, "rolling_window": True, "width": 3,
        "height": 3, "resolution": .05}


def test_topics_can_be_others():
    nodes, _ = load(NAVIGATION, "move_base", "cmd_vel_topic:=/c", "odom_topic:=/o")
    assert dict(nodes["/move_base"].remap_args) == {"cmd_vel": "/c", "odom": "/o"}
    assert dict(load(NAVIGATION, "amcl", "scan_topic:=s")[0]["/amcl"].remap_args) == {"scan": "s"}


def test_the_map_is_of_the_world():
    """In the world's frame: free where the robot starts, a column in the middle."""
    grid, yaw = read_map(NAVIGATION / "maps" / "map.yaml")
    start = grid.cells_of([(-2.0, -0.5)])[0]
    assert grid.cells[tuple(start)] == 0 and yaw == 0.0
    column = grid.cells_of([(0.0, 0.0)])[0]
    assert grid.cells[tuple(column)] != 0
    assert (grid.cells[column[0], column[1] - 5:column[1]] == 100).any()
