"""Tutorials' keyboard scripts call `xset r off`; it has to be there, with a screen or without."""

import os
import subprocess


def test_xset_is_there_and_says_that_it_has_no_screen():
    nowhere = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    ended = subprocess.run(["xset", "r", "off"], env=nowhere, capture_output=True, text=True,
                           timeout=60, check=False)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert "unable to open display" in ended.stderr
