"""Checks that each definition is upstream's on the wire; the sums are gazebo_ros_pkgs's, noetic."""

from pathlib import Path

import pytest
from genmsg import MsgContext, load_depends
from genmsg.gentools import compute_md5
from genmsg.msg_loader import load_msg_from_file, load_srv_from_file
from rospkg import RosPack

HERE = Path(__file__).resolve().parents[1]

MESSAGE_MD5 = {
    "ContactState": "48c0ffb054b8c444f870cecea1ee50d9",
    "ContactsState": "acbcb1601a8e525bf72509f18e6f668d",
    "LinkState": "0818ebbf28ce3a08d48ab1eaa7309ebe",
    "LinkStates": "48c080191eb15c41858319b4d8a609c2",
    "ModelState": "9330fd35f2fcd82d457e54bd54e10593",
    "ModelStates": "48c080191eb15c41858319b4d8a609c2",
    "ODEJointProperties": "1b744c32a920af979f53afe2f9c3511f",
    "ODEPhysics": "667d56ddbd547918c32d1934503dc335",
    "PerformanceMetrics": "884f71fd5037b886ec5e126b83c4425a",
    "SensorPerformanceMetric": "01762ded18cfe9ebc7c8222667c99547",
    "WorldState": "de1a9de3ab7ba97ac0e9ec01a4eb481e",
}
SERVICE_MD5 = {
    "ApplyBodyWrench": "585b9f9618aa0581b207e2f2d90866bc",
    "ApplyJointEffort": "c0039811b8cc919490b3cff748cdf46b",
    "BodyRequest": "5eade9afe7f232d78005bd0cafeab755",
    "DeleteLight": "ae11ea8100d536d5b92c2b5917abf912",
    "DeleteModel": "9ce56b4e9e54616de25d796dc972a262",
    "GetJointProperties": "7b30be900f50aa21efec4a0ec92d91c9",
    "GetLightProperties": "df2cef87e13e2e6990e81e8aaa454c19",
    "GetLinkProperties": "0e06a70386d0ee3fb880c02f23fcd821",
    "GetLinkState": "09d6c98cce97b35f7ab9bd70300657ab",
    "GetModelProperties": "5717f7bd34ed990fa80e28b3015027a3",
    "GetModelState": "4c515e936d3319c9610c559c60bfc3d4",
    "GetPhysicsProperties": "575a5e74786981b7df2e3afc567693a6",
    "GetWorldProperties": "36bb0f2eccf4d8be971410c22818ba3f",
    "JointRequest": "0be1351618e1dc030eb7959d9a4902de",
    "SetJointProperties": "15a76e921b1410c698d82782ea5fa370",
    "SetJointTrajectory": "88f5c10979e3f9649d5ae87a3b12aa65",
    "SetLightProperties": "e6f13430c57278bb364aca53a1bf5ebf",
    "SetLinkProperties": "d534ce1b36ee99de0ffa806c3a6348f0",
    "SetLinkState": "8a5146eb66ae4d26b0860b08f3f271be",
    "SetModelConfiguration": "10e3139d3b669c40afc057d38956fff7",
    "SetModelState": "5b3ab0281d4f5445def017e3a2e4a07b",
    "SetPhysicsProperties": "97e2057080558ce4730434b5fae75c91",
    "SpawnModel": "9ed9c82c96abe1a00c3e8cdaeee24413",
}


def search_path() -> dict[str, list[str]]:
    packages = RosPack()
    others = ("geometry_msgs", "std_msgs", "trajectory_msgs")
    path = {name: [f"{packages.get_path(name)}/msg"] for name in others}
    return path | {"gazebo_msgs": [str(HERE / "msg")]}


def md5(kind: str, name: str) -> str:
    """The sum genmsg gives the file, which is what generated code sends in its handshake."""
    context = MsgContext.create_default()
    load = load_msg_from_file if kind == "msg" else load_srv_from_file
    spec = load(context, str(HERE / kind / f"{name}.{kind}"), f"gazebo_msgs/{name}")
    load_depends(context, spec, search_path())
    return compute_md5(context, spec)


@pytest.mark.parametrize("name", MESSAGE_MD5)
def test_message_is_upstreams(name):
    assert md5("msg", name) == MESSAGE_MD5[name]


@pytest.mark.parametrize("name", SERVICE_MD5)
def test_service_is_upstreams(name):
    assert md5("srv", name) == SERVICE_MD5[name]


@pytest.mark.parametrize(("kind", "sums"), [("msg", MESSAGE_MD5), ("srv", SERVICE_MD5)])
def test_no_definition_is_missing_or_extra(kind, sums):
    assert {file.stem for file in (HERE / kind).iterdir()} == set(sums)
