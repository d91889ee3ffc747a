"""The manager's rules, without a master: states, switching, conflicts, faults, waiting."""

import threading
import time

import pytest

from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.rate import Rate
from bullet_sim.errors import PluginError
from bullet_sim_ros.control import registry
from bullet_sim_ros.control.manager import ControllerManager
from bullet_sim_ros.control.switching import ManagerError

CLAIMS = {"wheel": ["left"], "also_wheel": ["left"], "arm": ["right"], "both": ["left", "right"],
          "reader": [], "failing": ["right"]}
LIMIT = 60.0  # s, wall


class Recorder(registry.Controller):
    """Notes what it is asked to do."""

    def __init__(self, context):
        super().__init__(context)
        for joint in CLAIMS[context.name]:
            context.claim(joint)
        self.calls = []

    def start(self, time):
        self.calls.append(("start", time))

    def update(self, time, period):
        self.calls.append(("update", time, period))
        for handle in self.context.claims.values():
            handle.command = 7.0
        if self.context.name == "failing":
            raise ValueError("out of order")

    def stop(self, time):
        self.calls.append(("stop", time))


class Refusing(registry.Controller):
    def __init__(self, context):
        raise PluginError("joint 'x' is bent")


class FakeContext:
    def __init__(self, name):
        self.name, self.namespace, self.closed = name, f"/r/{name}", False
        kind = {"refusing": "test/Refusing", "unknown": "test/Recorde", "untyped": None}.get(
            name, "test/Recorder")
        self.parameters = ControllerParameters(self.namespace, {"type": kind} if kind else {})
        self.claims, self.tasks = {}, []

    def claim(self, joint):
        self.claims[joint] = CommandHandle(JointHandle(joint, "continuous"), "effort")

    def close(self):
        self.closed = True


@pytest.fixture(autouse=True)
def types(monkeypatch):
    monkeypatch.setattr(registry, "_registry",
                        {"test/Recorder": Recorder, "test/Refusing": Refusing})


class Bench:
    """A manager whose loop turns in a thread of its own, as the simulation's does."""

    def __init__(self, *names):
        self.contexts = {}
        self.ended = False
        self.manager = ControllerManager(self.open_context, lambda: self.ended)
        self.loop = None
        for name in names:
            self.manager.load(name)

    def open_context(self, name):
        self.contexts[name] = FakeContext(name)
        return self.contexts[name]

    def __enter__(self):
        self._end = threading.Event()

        def turn():
            tick = 0
            while not self._end.wait(0.001):
                tick += 1
                self.manager.update(tick * 0.001, 0.001)

        self.loop = threading.Thread(target=turn)
        self.loop.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        self.loop.join()

    def switch(self, start=(), stop=(), strict=True):
        self.manager.switch(start, stop, strict, LIMIT)

    def states(self):
        return {loaded.name: loaded.state for loaded in self.manager.list()}

    def calls(self, name):
        return next(loaded for loaded in self.manager.list() if loaded.name == name
                    ).controller.calls


def test_from_loaded_to_unloaded():
    with Bench("wheel", "reader") as bench:
        assert bench.states() == {"wheel": "initialized", "reader": "initialized"}
        bench.switch(["wheel"])
        assert bench.states() == {"wheel": "running", "reader": "initialized"}
        with pytest.raises(ManagerError, match=(
                "Could not unload controller with name 'wheel' because it is still running")):
            bench.manager.unload("wheel")
        bench.switch(stop=["wheel"])
        calls = bench.calls("wheel")
        assert bench.states()["wheel"] == "stopped"
        assert [call[0] for call in (calls[0], calls[1], calls[-1])] == ["start", "update", "stop"]
        assert bench.contexts["wheel"].claims["left"].command == 0.0
        bench.switch(["wheel"])
        bench.switch(stop=["wheel"])
        bench.manager.unload("wheel")
        assert list(bench.states()) == ["reader"]
        assert bench.contexts["wheel"].closed


@pytest.mark.parametrize(("name", "parts"), [
    ("untyped", ["Could not load controller 'untyped' because the type was not specified. Did you "
                 "load the controller configuration on the parameter server (namespace: "
                 "'/r/untyped')?", "/r/untyped/type"]),
    ("unknown", ["Could not load controller 'unknown' because controller type 'test/Recorde' does "
                 "not exist", "did you mean test/Recorder?", "list_controller_types"]),
    ("refusing", ["Initializing controller 'refusing' failed", "joint 'x' is bent"]),
])
def test_what_cannot_be_loaded(name, parts):
    bench = Bench()
    with pytest.raises(ManagerError) as error:
        bench.manager.load(name)
    assert all(part in str(error.value) for part in parts)
    assert bench.contexts[name].closed
    assert bench.manager.list() == []


def test_a_name_is_loaded_once():
    bench = Bench("wheel")
    with pytest.raises(ManagerError, match="A controller named 'wheel' was already loaded inside "
                       "the controller manager"):
        bench.manager.load("wheel")
    with pytest.raises(ManagerError, match="Could not unload controller with name 'whel' because "
                       "no controller with this name exists; there are: wheel"):
        bench.manager.unload("whel")


SWITCHES = [
    # running before, start, stop: strict's error or None, running after a strict and a best one
    ([], ["wheel"], [], None, ["wheel"]),
    (["wheel"], [], ["wheel"], None, []),
    (["wheel"], ["arm"], ["wheel"], None, ["arm"]),
    (["wheel"], ["also_wheel"], ["wheel"], None, ["also_wheel"]),
    (["wheel"], [], [], None, ["wheel"]),
    ([], ["wheel", "wheel"], [], None, ["wheel"]),
    ([], ["nobody", "wheel"], [], "not start controller with name 'nobody'", ["wheel"]),
    (["wheel"], [], ["nobody", "wheel"], "not stop controller with name 'nobody'", []),
    (["wheel"], ["wheel", "arm"], [], "'wheel' is already running", ["wheel", "arm"]),
    (["wheel"], [], ["arm", "wheel"], "not stop controller 'arm' since it is not running", []),
]


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize(("before", "start", "stop", "error", "after"), SWITCHES)
def test_switching(strict, before, start, stop, error, after):
    with Bench(*CLAIMS) as bench:
        bench.switch(before)
        if strict and error:
            with pytest.raises(ManagerError, match=error):
                bench.switch(start, stop)
            after = before
        else:
            bench.switch(start, stop, strict)
        running = [name for name, state in bench.states().items() if state == "running"]
        assert sorted(running) == sorted(after)


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize(("before", "start", "stop", "error"), [
    (["wheel"], ["both"], [], "Could not switch controllers, due to resource conflict: "
     "joint 'left' is claimed by 'wheel' .running. and by 'both'"),
    ([], ["wheel", "also_wheel"], [], "joint 'left' is claimed by 'wheel'"),
    (["wheel"], ["wheel"], ["wheel"],
     "Could no start or stop controller 'wheel' because of conflicting switching command"),
])
def test_refused_however_it_is_asked(strict, before, start, stop, error):
    with Bench(*CLAIMS) as bench:
        bench.switch(before)
        states = bench.states()
        with pytest.raises(ManagerError, match=error):
            bench.switch(start, stop, strict)
        assert bench.states() == states


def test_without_updates_a_switch_waits_and_is_withdrawn_after_its_time_out():
    bench = Bench("wheel")
    with pytest.raises(ManagerError, match=r"within 0.05 s: is physics paused"):
        bench.manager.switch(["wheel"], [], True, 0.05)
    bench.manager.update(1.0, 0.001)
    assert bench.states() == {"wheel": "initialized"}


def test_what_a_paused_world_has_still_to_start_is_waiting():
    bench = Bench("wheel")
    asked = threading.Thread(target=bench.manager.switch, args=(["wheel"], [], True))
    asked.start()
    (wheel,) = bench.manager.list()
    end = time.monotonic() + LIMIT
    while bench.manager.state_of(wheel) != "waiting" and time.monotonic() < end:
        time.sleep(0.001)
    assert bench.manager.state_of(wheel) == "waiting"
    bench.manager.update(0.0, 0.001)
    asked.join(LIMIT)
    assert bench.manager.state_of(wheel) == "running"


def test_a_switch_waits_no_longer_than_the_simulation_lives():
    bench = Bench("wheel")
    bench.ended = True
    with pytest.raises(ManagerError, match="is gone"):
        bench.manager.switch(["wheel"], [], True, 0.0)


def test_a_faulty_controller_is_stopped_and_the_others_go_on(caplog):
    with Bench("failing", "wheel") as bench:
        bench.switch(["failing", "wheel"])
    bench.manager.update(9.0, 0.001)
    assert bench.states() == {"failing": "aborted", "wheel": "running"}
    assert "Controller 'failing' failed and is stopped: ValueError: out of order" in caplog.text
    assert bench.contexts["failing"].claims["right"].command == 0.0
    assert bench.calls("wheel")[-1] == ("update", 9.0, 0.001)
    assert len(bench.calls("failing")) == 2


def test_after_an_emergency_stop_what_runs_starts_anew():
    with Bench("wheel", "arm") as bench:
        bench.switch(["wheel"])
    bench.manager.update(9.0, 0.001, restart=True)
    assert bench.calls("wheel")[-3:] == [("stop", 9.0), ("start", 9.0), ("update", 9.0, 0.001)]
    assert bench.calls("arm") == []


def test_reloading_needs_force_while_there_are_controllers():
    # conforms: controller_manager services/reload_controller_libraries
    with Bench("wheel", "arm") as bench:
        bench.switch(["wheel"])
        with pytest.raises(ManagerError, match="still 2 controllers"):
            bench.manager.reload(force=False)
        bench.manager.reload(force=True)
        assert bench.manager.list() == []
        bench.manager.reload(force=False)


def test_duties_are_done_while_loaded_and_closing_ends_all():
    bench = Bench()
    done = []
    open_context = bench.manager._open_context

    def with_duty(name):
        context = open_context(name)
        context.tasks.append((Rate(100.0), lambda: done.append(name)))
        return context

    bench.manager._open_context = with_duty
    bench.manager.load("reader")
    for tick in range(21):
        bench.manager.update(tick * 0.001, 0.001)
    assert done == ["reader"] * 3
    bench.manager.close()
    assert bench.contexts["reader"].closed
    with pytest.raises(ManagerError, match="was deleted"):
        bench.manager.load("arm")
