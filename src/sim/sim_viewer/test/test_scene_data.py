"""What the 3D view gets: scenes, triangles, textures, and poses out of the simulator's messages."""

import asyncio
import io
import struct
import types

import cv2
import numpy as np
import pytest
from aiohttp import web
from gazebo_msgs.msg import LinkStates
from geometry_msgs.msg import Point, Pose, Quaternion, Twist
from sim_viewer.options import Options
from sim_viewer.page_scene import Meshes, mesh_bytes, page_scene
from sim_viewer.registry import Node
from sim_viewer.scene import SceneBroadcast
from sim_viewer.scene_sources import SimulatorSource
from sim_viewer.server import Server

from bullet_sim import pose as poses
from bullet_sim.description import Box, LightDescription, Material, Plane, SceneDescription, Visual
from bullet_sim.rendering.scene_text import SceneContent

HALF_TURN = (0.0, 0.0, 1.0, 0.0)


@pytest.fixture
def meshes():
    return Meshes()


def content(*links, lights=()):
    return SceneContent(SceneDescription(), lights, {
        ("robot", f"link{i}"): (poses.Pose((float(i), 0.0, 0.0), HALF_TURN), (visual,))
        for i, visual in enumerate(links)})


def box(size=1.0, **look):
    return Visual("box", Box((size,) * 3), material=Material(**look))


def test_a_link_has_its_name_pose_and_colours(meshes):
    page = page_scene(content(box(diffuse=(1.0, 0.5, 0.0, 1.0))), meshes)
    (link,) = page["links"]
    assert (link["name"], link["model"]) == ("robot::link0", "robot")
    assert link["pose"] == [0.0, 0.0, 0.0, *HALF_TURN] and link["plane"] is None
    assert link["parts"][0]["material"]["diffuse"] == (1.0, 0.5, 0.0, 1.0)
    assert page["background"] == (0.7, 0.7, 0.7, 1.0)


def test_links_that_look_alike_share_a_mesh_that_keeps_its_number(meshes):
    def numbers(page):
        return [link["parts"][0]["mesh"] for link in page["links"]]

    one, same, other = numbers(page_scene(content(box(), box(), box(2.0)), meshes))
    assert one == same != other
    assert numbers(page_scene(content(box(2.0), box(3.0)), meshes))[0] == other


def test_larger_planes_give_way(meshes):
    planes = [Visual("p", Plane((0.0, 0.0, 1.0), (size, size))) for size in (100.0, 5.0)]
    assert [link["plane"] for link in page_scene(content(*planes), meshes)["links"]] == [1, 0]


def test_lights_point_where_their_pose_turns_them(meshes):
    light = LightDescription("sun", type="directional", direction=(1.0, 0.0, -1.0),
                             pose=poses.Pose((0.0, 0.0, 9.0), HALF_TURN))
    (shown,) = page_scene(content(lights=(light,)), meshes)["lights"]
    assert shown["direction"] == pytest.approx((-1.0, 0.0, -1.0))


def test_a_mesh_is_head_positions_normals_uv_and_triangles(meshes):
    shape = meshes.shapes([(box(2.0),)])[0]
    data = mesh_bytes(shape.parts[0])
    corners, triangles, has_uv, _ = struct.unpack_from("<4I", data)
    assert (corners, triangles, has_uv) == (24, 12, 1)
    assert len(data) == 16 + corners * 32 + triangles * 12
    positions = np.frombuffer(data, "<f4", 3 * corners, 16)
    assert np.abs(positions).max() == 1.0
    assert np.frombuffer(data, "<u4", 36, 16 + corners * 32).max() == 23


def test_textures_that_browsers_cannot_read_become_png(tmp_path):
    path = tmp_path / "red.ppm"
    cv2.imwrite(str(path), np.full((4, 4, 3), (0, 0, 255), np.uint8))
    answer = fetch(content(box(texture=str(path))), "texture")
    assert answer.content_type == "image/png"
    assert tuple(cv2.imdecode(np.frombuffer(answer.body, np.uint8), 1)[0, 0]) == (0, 0, 255)


def test_a_texture_of_a_stranger_s_size_is_not_unpacked(tmp_path):
    path = tmp_path / "huge.ppm"
    path.write_bytes(b"P6\n2000000 1000\n255\n" + bytes(100))
    with pytest.raises(web.HTTPNotFound):
        fetch(content(box(texture=str(path))), "texture")


def fetch(scene, what):
    """The answer for the first mesh or texture that the page is told of."""
    class Request:
        match_info: dict

    async def story():
        node = Node(Options(), asyncio.get_running_loop())
        part = page_scene(scene, node.shared(Meshes))["links"][0]["parts"][0]
        Request.match_info = {"kind": what, "number": str(
            part["mesh"] if what == "mesh" else part["material"]["texture"])}
        return await Server(node).serve_shape(Request)

    return asyncio.run(story())


def test_a_mesh_is_served_as_bytes():
    answer = fetch(content(box()), "mesh")
    assert answer.content_type == "application/octet-stream" and len(answer.body) > 16


def states(*links):
    """Serialized gazebo_msgs/LinkStates with a link at each of these x."""
    msg = LinkStates()
    for name, x in links:
        msg.name.append(name)
        msg.pose.append(Pose(Point(x, 2.0, 3.0), Quaternion(0.0, 0.0, 0.0, 1.0)))
        msg.twist.append(Twist())
    buffer = io.BytesIO()
    msg.serialize(buffer)

    class Raw:
        _buff = buffer.getvalue()

    return Raw


def test_poses_are_read_from_the_messages_bytes():
    source = SimulatorSource(None)
    assert source.poses() is None
    source._take_states(states(("robot::base", 1.0), ("盒子::link", 4.0)))
    names, rows = source.poses()
    assert names == ("robot::base", "盒子::link")
    assert rows.tolist() == [[1, 2, 3, 0, 0, 0, 1], [4, 2, 3, 0, 0, 0, 1]]
    assert source.poses() is None  # no news
    source._take_states(states(("robot::base", 5.0), ("盒子::link", 4.0)))
    assert source.poses()[1][0, 0] == 5.0
    source._take_states(states(("robot::base", 5.0)))
    assert source.poses()[0] == ("robot::base",)
    source._take_states(states())
    assert source.poses()[1].shape == (0, 7)


def test_what_only_trembles_is_not_sent():
    broadcast, sent = SceneBroadcast(types.SimpleNamespace(shared=lambda kind: None)), []
    broadcast._watchers[lambda data, keep=False: sent.append(data)] = "poses"
    rows = np.float32([[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]])
    broadcast._take(("robot::base",), rows)
    assert sent == [{"names": ("robot::base",)}, rows.tobytes()]
    for _ in range(5):  # 1 micrometre to and fro
        broadcast._take(("robot::base",), rows + np.float32(1e-6))
        broadcast._take(("robot::base",), rows)
    assert len(sent) == 2
    for step in range(1, 21):  # slow, and all the same on its way
        broadcast._take(("robot::base",), rows + np.float32(2e-6 * step))
    assert len(sent) > 4


def test_a_simulator_that_is_gone_is_forgotten():
    source = SimulatorSource(None)
    source._take_scene(types.SimpleNamespace(data="{}"))
    source._take_states(states(("robot::base", 1.0)))
    source.forget()
    assert source.scene(known=False) is None and source.poses() is None
