"""/gazebo/scene, which is ours: what there is to see, for the page in the browser."""

from gazebo_msgs.msg import ModelState
from geometry_msgs.msg import Point, Pose

from bullet_sim.rendering.scene_text import scene_from_text

SCENE = "/gazebo/scene"
BOX = """<model name="{name}"><link name="body"><visual name="seen"><geometry><box>
  <size>1 1 1</size></box></geometry></visual></link></model>"""


def turn(bench) -> None:
    """What the loop calls in each of its turns."""
    for function in bench.simulation.each_turn:
        function()


def links(message):
    return scene_from_text(message.data).links


def test_nobody_listens_so_nothing_is_made(bench):
    found = bench.listen(SCENE, listeners=0)
    bench.run(0.05)
    assert found == []


def test_it_comes_once_and_anew_when_models_come_and_go(bench):
    found = bench.listen(SCENE)
    bench.run(0.1)
    assert len(found) == 1 and ("ground_plane", "link") in links(found[0])
    bench.spawn(BOX.format(name="crate"))
    bench.run(0.1)
    assert len(found) == 2 and ("crate", "body") in links(found[1])
    bench.delete("crate")
    bench.run(0.1)
    assert len(found) == 3 and ("crate", "body") not in links(found[2])


def test_it_is_latched(bench):
    (publisher,) = bench.graph.topics[SCENE].publishers
    assert publisher.options["latch"]


def test_what_is_moved_in_a_paused_world_is_told(bench):
    found = bench.listen(SCENE)
    bench.spawn(BOX.format(name="crate"))
    bench.run(0.02)
    bench.world.paused = True
    turn(bench)
    before = len(found)
    turn(bench)
    assert len(found) == before  # it stands still
    state = ModelState(model_name="crate", pose=Pose(position=Point(3.0, 0.0, 9.0)))
    state.pose.orientation.w = 1.0
    bench.send("/gazebo/set_model_state", state)
    bench.simulation.mailbox.run_pending(0.01)
    turn(bench)
    assert links(found[-1])["crate", "body"][0].position == (3.0, 0.0, 9.0)


def test_without_ros_network_there_is_none(make_bench):
    bench = make_bench(enable_ros_network=False)
    assert SCENE not in bench.advertised()
    bench.run(0.01)
