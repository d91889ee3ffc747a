"""Checks that each definition is upstream's on the wire, against the sums in md5.yaml."""

import subprocess
from pathlib import Path

import pytest
import yaml
from genmsg import MsgContext, load_depends
from genmsg.gentools import compute_md5
from genmsg.msg_loader import load_msg_from_file, load_srv_from_file
from rospkg import RosPack

HERE = Path(__file__).resolve().parents[1]
SUMS = yaml.safe_load((Path(__file__).parent / "md5.yaml").read_text(encoding="utf-8"))
DEFINITIONS = [(package, kind, name) for package, kinds in SUMS.items()
               for kind, names in kinds.items() for name in names]
DEPENDENCIES = ("actionlib_msgs", "geometry_msgs", "sensor_msgs", "std_msgs", "trajectory_msgs")
GENACTION = "/usr/lib/actionlib_msgs/genaction.py"


@pytest.fixture(scope="module")
def search_path(tmp_path_factory):
    """Folders with .msg files by package; those of .action files are made as the build does."""
    packages = RosPack()
    path = {name: [f"{packages.get_path(name)}/msg"] for name in DEPENDENCIES}
    for package in SUMS:
        made = tmp_path_factory.mktemp(package)
        for action in sorted((HERE / package).glob("action/*.action")):
            subprocess.run([GENACTION, str(action), "-o", str(made)], check=True)
        path[package] = [str(HERE / package / "msg"), str(made)]
    return path


@pytest.mark.parametrize(("package", "kind", "name"), DEFINITIONS)
def test_definition_is_upstreams(package, kind, name, search_path):
    # conforms: turtlebot3_msgs, turtlebot3_msgs/SensorState, turtlebot3_msgs/Sound
    # conforms: turtlebot3_msgs/VersionInfo
    context = MsgContext.create_default()
    load = load_msg_from_file if kind == "msg" else load_srv_from_file
    folders = search_path[package] if kind == "msg" else [str(HERE / package / "srv")]
    file = next(f for folder in folders if (f := Path(folder, f"{name}.{kind}")).is_file())
    spec = load(context, str(file), f"{package}/{name}")
    load_depends(context, spec, search_path)
    assert compute_md5(context, spec) == SUMS[package][kind][name]


@pytest.mark.parametrize("package", SUMS)
def test_no_definition_is_missing_or_extra(package, search_path):
    messages = {file.stem for folder in search_path[package] for file in Path(folder).glob("*")}
    services = {file.stem for file in (HERE / package).glob("srv/*")}
    assert (messages, services) == (set(SUMS[package]["msg"]), set(SUMS[package]["srv"]))
