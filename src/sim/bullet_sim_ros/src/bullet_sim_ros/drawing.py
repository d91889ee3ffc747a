"""Pictures are drawn, made into messages and sent beside the physics, by threads of their own.

One draws. What a depth camera's picture becomes takes longer than that (33 MB of points at
1920x1080): the other one does it while the next is drawn. Threads are enough, they need not be
processes: llvmpipe, OpenCV and the network work without Python's lock, and what a picture is made
from never changes while it is drawn.
"""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

import rospy

from bullet_sim.profiler import Profiler
from bullet_sim.rendering.renderer import Renderer, open_renderer

PATIENCE = 1.0  # s, wall


class DrawingThread:
    """Opens the renderer at once, while the world is still being loaded; then does jobs in turn."""

    def __init__(self, profiler: Profiler):
        self._executor = ThreadPoolExecutor(1, "drawing")
        self._after = ThreadPoolExecutor(1, "after drawing")
        self._last: Future | None = None
        self._handed_on: Future | None = None
        self._renderer = self._executor.submit(open_renderer, profiler=profiler)
        self._reported = False

    def renderer(self) -> Renderer:
        """The renderer, or the SimulationError that opening it ended with. For the loop's thread.

        Only that one logs: when it loads a body, it keeps PyBullet's chatter from the terminal, and
        with it what another thread logs.
        """
        renderer = self._renderer.result()
        if not self._reported:
            self._reported = True
            rospy.loginfo("Cameras are drawn by %s", renderer.name)
        return renderer

    def submit(self, job: Callable[[], None]) -> Future:
        """Have something done after all that was submitted before."""
        self._last = self._executor.submit(job)
        return self._last

    def hand_on(self, job: Callable[[], None]) -> Future:
        """From a job: have its rest done while the next one draws, after the rest before it, for
        which this waits.
        """
        self.settle_rest()
        self._handed_on = self._after.submit(job)
        return self._handed_on

    def trim(self) -> None:
        """Give back the memory of pictures, now; only a renderer that is very slow does so later.

        The simulation waits meanwhile, so the wait has a limit.
        """
        wait([self.submit(self.renderer().trim)], PATIENCE)

    def settle(self) -> None:
        """Wait until nothing is being drawn, nor made of what was drawn."""
        if self._last is not None:
            self._last.exception()
        self.settle_rest()

    def settle_rest(self) -> None:
        """Wait for what was handed on."""
        if self._handed_on is not None:
            self._handed_on.exception()

    def close(self) -> None:
        """End the threads; what has not begun is dropped."""
        self._executor.shutdown(cancel_futures=True)
        self._after.shutdown(cancel_futures=True)
        if not self._renderer.cancelled() and self._renderer.exception() is None:
            self._renderer.result().close()
