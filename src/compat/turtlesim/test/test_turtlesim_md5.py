"""Checks that each definition is upstream's on the wire; the sums are ros_tutorials's, noetic."""

from pathlib import Path

import pytest
from genmsg import MsgContext
from genmsg.gentools import compute_md5
from genmsg.msg_loader import load_msg_from_file, load_srv_from_file

PACKAGE = Path(__file__).resolve().parents[1]
SUMS = {
    "msg/Color.msg": "353891e354491c51aabe32df673fb446",
    "msg/Pose.msg": "863b248d5016ca62ea2e895ae5265cf9",
    "srv/Kill.srv": "c1f3d28f1b044c871e6eff2e9fc3c667",
    "srv/SetPen.srv": "9f452acce566bf0c0954594f69a8e41b",
    "srv/Spawn.srv": "0b2d2e872a8e2887d5ed626f2bf2c561",
    "srv/TeleportAbsolute.srv": "a130bc60ee6513855dc62ea83fcc5b20",
    "srv/TeleportRelative.srv": "9d5c2dcd348ac8f76ce2a4307bd63a13",
}


@pytest.mark.parametrize("file", SUMS)
def test_definition_is_upstreams(file):
    path, context = PACKAGE / file, MsgContext.create_default()
    load = load_msg_from_file if path.suffix == ".msg" else load_srv_from_file
    assert compute_md5(context, load(context, str(path), f"turtlesim/{path.stem}")) == SUMS[file]


def test_no_definition_is_missing_or_extra():
    files = {f"{path.parent.name}/{path.name}" for path in PACKAGE.glob("*/*.[ms][sr][gv]")}
    assert files == set(SUMS)
