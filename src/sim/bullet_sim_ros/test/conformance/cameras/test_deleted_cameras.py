"""A camera takes all with it that it was drawn in, and at once: before delete_model answers."""

import threading
import time
import weakref

import pytest
from camera_models import eye

from bullet_sim.sensors.camera import Camera

PLUGINS = [("libgazebo_ros_camera.so", "camera", "/eye/image_raw"),
           ("libgazebo_ros_openni_kinect.so", "depth", "/eye/points")]
LENS = """<image><width>32</width><height>24</height></image>
  <noise><type>gaussian</type><mean>0</mean><stddev>0.02</stddev></noise>
  <distortion><k1>-0.1</k1></distortion>"""


@pytest.fixture
def cameras(monkeypatch):
    """Weak references to all cameras, in the order in which they were made."""
    made, begin = [], Camera.__init__

    def noted(self, *arguments):
        begin(self, *arguments)
        made.append(weakref.ref(self))

    monkeypatch.setattr(Camera, "__init__", noted)
    return made


def see(bench, topic):
    seen = bench.listen(topic)
    bench.run(0.3)
    assert seen


def test_the_memory_of_pictures_goes_with_the_camera(bench):
    # conforms: libgazebo_ros_camera.so
    bench.spawn(eye(PLUGINS[0][0]))
    see(bench, "/eye/image_raw")
    drawing = bench.simulation._drawing
    renderer = drawing.renderer()
    assert renderer._targets and renderer._prepared
    drawing.submit(lambda: time.sleep(0.1))  # it has something else to do meanwhile
    bench.delete("eye")
    assert not renderer._targets and not renderer._prepared and not renderer._context.objects


@pytest.mark.parametrize("plugin, kind, topic", PLUGINS)
def test_no_camera_waits_for_the_collector(bench, cameras, no_collector, plugin, kind, topic):
    # conforms: libgazebo_ros_camera.so, libgazebo_ros_openni_kinect.so
    bench.spawn(eye(plugin, "<updateRate>10</updateRate>", LENS, kind))
    see(bench, topic)
    assert [camera() is None for camera in cameras] == [False]
    bench.delete("eye")
    assert [camera() is None for camera in cameras] == [True]


def test_a_camera_that_has_gone_is_not_tried_out(bench, monkeypatch):
    # conforms: libgazebo_ros_camera.so
    tried = []
    monkeypatch.setattr(Camera, "render", lambda *arguments: tried.append(arguments))
    gone = threading.Event()
    bench.simulation._drawing.submit(gone.wait)  # nothing is drawn until then
    bench.spawn(eye(PLUGINS[0][0]))
    (host,) = bench.simulation.sensors()
    host.on_close(gone.set)
    bench.delete("eye")
    bench.simulation._drawing.settle()
    assert tried == []
