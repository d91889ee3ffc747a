"""Makes a .test file an item of pytest, and keeps pytest away from the scripts that rostest runs.

Makes the models that come with the simulator, so that tests see their TOML files as they are now,
and TurtleBot3's worlds and the packages that are only a name, if there are none.
"""

import os
import runpy
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent / "scripts"))

from run_tests_files import (  # noqa: F401  hooks
    MARK,
    ROOT,
    pytest_addoption,
    pytest_collect_file,
    pytest_pycollect_makemodule,
    pytest_runtest_makereport,
    pytest_runtest_protocol,
    pytest_xdist_make_scheduler,
    rostest_scripts,
)

# Of a worker its controller has made them, of a file with a process of its own the run around it.
if "PYTEST_XDIST_WORKER" not in os.environ and os.environ.get(MARK, "").count("/") < 2:
    runpy.run_path(str(ROOT / "src/sim/bullet_sim/src/bullet_sim/props.py"), run_name="__main__")
    made = ["name_packages"]  # for after a `git pull`
    if (ROOT / "src/compat/turtlebot3_gazebo").is_dir():
        made.append("turtlebot3_worlds")
    subprocess.run([sys.executable, "-B", ROOT / "tools/makers", *made],
                   stdout=subprocess.DEVNULL, check=False)
collect_ignore = sorted(map(str, rostest_scripts()))
