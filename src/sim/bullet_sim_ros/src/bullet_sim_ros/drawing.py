"""Camera images are rendered, converted to messages and published in two threads of their own.

The first renders. Converting a depth camera's image takes longer than that (33 MB of points at
1920x1080): the second thread does it while the next image is rendered. Processes are not needed:
llvmpipe, OpenCV and the network release Python's GIL, and the data that an image is rendered from
never changes meanwhile.
"""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

import rospy

from bullet_sim.profiler import Profiler
from bullet_sim.rendering.renderer import Renderer, open_renderer

PATIENCE = 1.0  # s, wall


class DrawingThread:
    """Opens the renderer at once, while the world is still loading; then runs jobs in order."""

    def __init__(self, profiler: Profiler):
        self._executor = ThreadPoolExecutor(1, "drawing")
        self._after = ThreadPoolExecutor(1, "after drawing")
        self._last: Future | None = None
        self._handed_on: Future | None = None
        self._renderer = self._executor.submit(open_renderer, profiler=profiler)
        self._reported = False

    def renderer(self) -> Renderer:
        """The renderer; NoRenderer if opening it failed. To be called in the loop's thread.

        Only that thread may log: while it loads a body, it silences the terminal because of
        PyBullet's output, and would swallow the log lines of another thread, too.
        """
        renderer = self._renderer.result()
        if not self._reported:
            self._reported = True
            rospy.loginfo("Cameras are drawn by %s", renderer.name)
        return renderer

    def submit(self, job: Callable[[], None]) -> Future:
        """Run a job after all that were submitted before."""
        self._last = self._executor.submit(job)
        return self._last

    def hand_on(self, job: Callable[[], None]) -> Future:
        """From a job: run its second part in the second thread, while the next job renders.

        Waits for the second part of the job before it.
        """
        self.settle_rest()
        self._handed_on = self._after.submit(job)
        return self._handed_on

    def trim(self) -> None:
        """Release the memory of images now; only a very slow renderer does so later.

        The simulation waits meanwhile, so the wait has a limit.
        """
        wait([self.submit(self.renderer().trim)], PATIENCE)

    def settle(self) -> None:
        """Wait until both threads have done all their jobs."""
        if self._last is not None:
            self._last.exception()
        self.settle_rest()

    def settle_rest(self) -> None:
        """Wait for the part that was handed on last."""
        if self._handed_on is not None:
            self._handed_on.exception()

    def close(self) -> None:
        """End the threads; jobs that have not begun are dropped."""
        self._executor.shutdown(cancel_futures=True)
        self._after.shutdown(cancel_futures=True)
        if not self._renderer.cancelled() and self._renderer.exception() is None:
            self._renderer.result().close()
