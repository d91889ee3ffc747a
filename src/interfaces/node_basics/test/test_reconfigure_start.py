"""What it costs a node that its settings can be changed while it runs."""

import subprocess
import sys

CODE = """
import sys, roslib
load_manifest = roslib.load_manifest
from node_basics.reconfigure import EntryServer
print('catkin_pkg' in sys.modules, roslib.load_manifest is load_manifest)
load_manifest('dynamic_reconfigure')
print('catkin_pkg' in sys.modules)
"""


def test_no_package_is_searched_at_the_import_and_a_script_may_still_do_so():
    done = subprocess.run([sys.executable, "-c", CODE], text=True, capture_output=True)
    assert done.stdout == "False True\nTrue\n", done.stderr
