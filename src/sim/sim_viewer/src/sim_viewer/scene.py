"""What the 3D view watches: `scene` (what links look like) and `poses` (where they are now).

Events of `poses` are JSON {"names": [...]} whenever the set of links changes, then bytes: float32
(n, 7) little-endian, x, y, z in m and the quaternion x, y, z, w of each, in the order of the names.
"""

import asyncio
from collections.abc import Callable
from typing import Any

import numpy as np
import rospy

from sim_viewer.page_scene import NOTHING, Meshes, page_scene
from sim_viewer.registry import Context, Node, Refused, watchable
from sim_viewer.scene_sources import RobotSource, SimulatorSource
from sim_viewer.tools.master import MasterView
from sim_viewer.transforms import Transforms

RATE_HZ = 20.0  # of poses, at most
SMALLEST_MOTION = 1e-5  # m, and of quaternions: less is not sent; a robot at rest moves less
TIMEOUT = 1.0  # s without a simulator before robot_description is shown

Send = Callable[..., None]
Source = SimulatorSource | RobotSource  # of a scene; called in a worker thread


class SceneBroadcast:
    """The scene for all browsers: the simulator's while there is one, else the robot's."""

    def __init__(self, node: Node):
        self._node = node
        self._meshes: Meshes = node.shared(Meshes)
        self._simulator = SimulatorSource(node.shared(MasterView))
        self._robot = RobotSource(node.shared(Transforms))
        self._shown: Source | None = None
        self._watchers: dict[Send, str] = {}
        self._scene: dict[str, Any] | None = None  # None: it is not known yet whether there is one
        self._names: tuple[str, ...] = ()
        self._rows = np.zeros((0, 7), np.float32)
        self._task: asyncio.Task | None = None

    def add(self, send: Send, what: str) -> None:
        """Send a watcher of `scene` or `poses` the present state and all changes."""
        self._watchers[send] = what
        if what == "scene":
            if self._scene is not None:
                send(self._scene)
        else:
            self._send_poses([send], names=True)
        if self._task is None:
            self._task = asyncio.create_task(self._run())

    def remove(self, send: Send) -> None:
        """Remove a watcher; with the last one all subscriptions end."""
        self._watchers.pop(send, None)
        if not self._watchers:
            self.close()

    def close(self) -> None:
        """End the task and its subscriptions."""
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _run(self) -> None:
        clock = self._node.loop.time
        seen = clock()
        try:
            while True:
                await asyncio.sleep(1 / RATE_HZ)
                if self._simulator.present():
                    seen = clock()
                    await self._show(self._simulator)
                    continue
                await self._find_simulator()
                if clock() - seen > TIMEOUT:
                    self._simulator.forget()
                    await self._show(self._robot)
                    if self._scene is None:
                        self._send_scene(NOTHING)
        finally:
            self._shown = None
            self._simulator.close()
            self._robot.close()

    async def _find_simulator(self) -> None:
        try:
            await self._node.run_in_thread(self._simulator.open)
        except Refused:
            pass  # the master is gone; existing connections still send

    def _send_scene(self, scene: dict[str, Any]) -> None:
        self._scene = scene
        for send in self._watching("scene"):
            send(scene)

    async def _show(self, source: Source) -> None:
        known, self._shown = source is self._shown, source
        try:
            content = await self._node.run_in_thread(source.scene, known)
            if content is not None:
                self._send_scene(
                    await self._node.run_in_thread(page_scene, content, self._meshes))
                # The scene has poses of its own, newer than those that were sent.
                self._names, self._rows = (), np.zeros((0, 7), np.float32)
            news = await self._node.run_in_thread(source.poses)
        except OSError:
            return  # the master is gone
        except Exception as error:  # caused by a file, or a message of another node
            rospy.logwarn_throttle(10, f"the scene cannot be shown: {error}")
            return
        if news is not None:
            self._take(*news)

    def _take(self, names: tuple[str, ...], rows: np.ndarray) -> None:
        renamed = names != self._names
        if not renamed and np.allclose(rows, self._rows, rtol=0.0, atol=SMALLEST_MOTION):
            return
        self._names, self._rows = names, rows
        self._send_poses(self._watching("poses"), renamed)

    def _send_poses(self, watchers: list[Send], names: bool) -> None:
        data = np.ascontiguousarray(self._rows, "<f4").tobytes()
        for send in watchers:
            if names:
                send({"names": self._names}, keep=True)
            send(data)

    def _watching(self, what: str) -> list[Send]:
        return [send for send, watched in self._watchers.items() if watched == what]


class _Watch:
    """A watch of the broadcast that all browsers share."""

    what = ""

    def __init__(self, context: Context, args: dict[str, Any], send: Send):
        self._broadcast: SceneBroadcast = context.node.shared(SceneBroadcast)
        self._send = send

    async def start(self) -> None:
        self._broadcast.add(self._send, self.what)

    async def stop(self) -> None:
        self._broadcast.remove(self._send)


@watchable("scene")
class SceneWatch(_Watch):
    """The scene, as `page_scene` returns it; sent again when it changes."""

    what = "scene"


@watchable("poses")
class PosesWatch(_Watch):
    """The poses of the links, as this module's docstring says."""

    what = "poses"
