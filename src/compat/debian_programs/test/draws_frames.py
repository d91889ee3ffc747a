"""view_frames as pages type it, and the other programs of tf beside it."""

import subprocess
import tempfile
import unittest
from pathlib import Path

from roslib.packages import find_node

LIMIT = 60.0  # s


class DrawsFrames(unittest.TestCase):
    def view_frames(self, folder, *words):
        return subprocess.run(["rosrun", "tf", "view_frames", *words], cwd=folder, text=True,
                              capture_output=True, timeout=LIMIT, check=False)

    def test_the_tree_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.view_frames(folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("frames.pdf generated", done.stdout)
            self.assertTrue(Path(folder, "frames.pdf").read_bytes().startswith(b"%PDF"))
            graph = Path(folder, "frames.gv").read_text(encoding="utf-8")
            self.assertIn('"base" -> "arm"', graph)
            self.assertIn('"arm" -> "hand"', graph)

    def test_a_folder_that_cannot_be_written_is_one_line(self):
        done = self.view_frames("/proc")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1))
        self.assertIn("frames.gv", done.stderr)

    def test_debians_other_programs_are_found(self):
        for name in ("tf_echo", "tf_monitor", "tf_remap", "static_transform_publisher"):
            self.assertTrue(find_node("tf", name))
        done = subprocess.run(["rosrun", "tf", "tf_echo"], capture_output=True, text=True,
                              timeout=LIMIT, check=False)
        self.assertIn("tf_echo source_frame target_frame", done.stdout)
