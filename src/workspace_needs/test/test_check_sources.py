"""What check says of a package's scripts and C++ nodes that will not run."""

import os
import subprocess
import time

import pytest
from workspace_needs.check import parameter_commands
from workspace_needs.check.findings import PROBLEM
from workspace_needs.check.sources import program_findings, script_findings
from workspace_needs.workspace import _files

from bullet_sim.errors import FormatError
from bullet_sim_ros.interface import ABSENT, APPROXIMATED


@pytest.fixture
def node(tmp_path):
    """Writes an executable script; what is found in its package."""
    path = tmp_path / "scripts" / "talker.py"
    path.parent.mkdir()

    def write(content: bytes) -> list[tuple[str, str]]:
        path.write_bytes(content)
        path.chmod(0o755)
        return [(finding.where, finding.how) for finding in program_findings(tmp_path)]
    write.path = path
    return write


@pytest.mark.parametrize("first", [b"#!/usr/bin/env python3\r\n", b"\xef\xbb\xbf#!/bin/sh\n"])
def test_the_command_that_is_named_mends_the_script(node, first):
    (where, how), = node(first + b"exit\n")
    assert where == str(node.path) and "no interpreter is found; type: sed -i" in how
    subprocess.run(how.partition("type: ")[2], shell=True, check=True)
    assert node(node.path.read_bytes()) == []


@pytest.mark.parametrize("first, named", [
    (b"#!/usr/bin/python2.7", "/usr/bin/python2.7 here; write #!/usr/bin/env python3"),
    (b"#! /usr/bin/env -S pythn3 -u", "pythn3 here"), (b"#!/opt/own/perl", "/opt/own/perl here"),
    (b"#!", "interpreter here")])
def test_an_interpreter_that_is_not_there(node, first, named):
    (_, how), = node(first + b"\n")
    assert how.startswith("there is no ") and named in how


@pytest.mark.parametrize("content", [
    b"#!/usr/bin/env python3\n", b"#!/bin/sh -e\nx\r\n",
    b"#!/usr/bin/env python2.7\n", b"#!/usr/bin/env -S A=1 python3 -u\n"])
def test_others_are_not_named(node, content):
    assert node(content) == []


def test_a_python_file_without_a_first_line(node):
    (_, how), = node(b"import os\n")
    assert how == ("it has no #!, so that rosrun starts it as a shell script; write "
                   "#!/usr/bin/env python3 there")


@pytest.mark.parametrize("folder, is_module", [("src/arm", True), ("scripts", False)])
def test_a_module_below_src_needs_no_first_line(tmp_path, folder, is_module):
    (tmp_path / "package.xml").touch()
    path = tmp_path / folder / "part.py"
    path.parent.mkdir(parents=True)
    (path.parent / "__init__.py").touch(0o755)
    path.write_text("import os\n")
    path.chmod(0o755)
    assert len(list(program_findings(tmp_path))) == len(list(script_findings(path))) == (
        0 if is_module else 1)
    path.chmod(0o644)
    assert list(script_findings(path)) == []


def test_what_catkin_starts_itself_needs_no_first_line(node):
    folder = node.path.parents[1]
    (folder / "package.xml").touch()
    (folder / "CMakeLists.txt").write_text(
        "# catkin_install_python(...)\n"
        "catkin_install_python(PROGRAMS scripts/talker.py DESTINATION x)")
    assert node(b"#!/usr/bin/python2.7\n") == []
    node.path.chmod(0o644)
    assert list(program_findings(folder)) == list(script_findings(node.path)) == []
    node.path.write_bytes(b"def f(:\n")
    assert list(program_findings(folder)) == list(script_findings(node.path)) != []
    (folder / "CMakeLists.txt").write_text(
        "# catkin_install_python(PROGRAMS scripts/talker.py)\ninstall(PROGRAMS scripts/talker.py)")
    node.path.write_bytes(b"#!/usr/bin/env python3\n")
    assert ["chmod +x" in found.how for found in program_findings(folder)] == [True]


def test_a_script_that_is_not_executable_is_named_with_the_command(node, tmp_path):
    (tmp_path / "package.xml").touch()
    node(b"#!/usr/bin/env python3\n")
    node.path.chmod(0o644)
    found, = program_findings(tmp_path)
    assert [found] == list(script_findings(node.path)) and found.status == PROBLEM
    (node.path.parent / "other.py").write_text("import os, talker\n")
    assert list(program_findings(tmp_path)) == []
    (node.path.parent / "other.py").unlink()
    subprocess.run(found.how.partition("type: ")[2], shell=True, check=True)
    assert list(program_findings(tmp_path)) == []


@pytest.mark.parametrize("body, part, status, how", [
    ("def f(:\n", "line 2", PROBLEM, "Python 3 cannot read it: invalid syntax"),
    ("x = 1\nprint 'hello'\n", "line 3", PROBLEM, "this is Python 2, and only Python 3 is here: "),
    (b"x = 1  # \xd6\xd0\n", "line 2", PROBLEM, "it is not UTF-8; save it as UTF-8"),
    ('if __name__ == "__main__":\n    import nobodys\n', "line 3", ABSENT,
     "Debian has no python3-nobodys"),
    ("return\n", "line 2", PROBLEM, "Python 3 cannot read it: 'return' outside function"),
    ("import moveit_commander\n", "line 2", ABSENT, "module moveit_commander is not here: MoveIt"),
    ("import os, rospyy.msg\n", "line 2", ABSENT, "is rospy meant?"),
    ("def f():\n    from urllib2 import x\n", "line 3", ABSENT, "Python 3 calls it urllib.request"),
    ("import numpy as np\nnp.float(1)\nnp.float(2)\n", "line 3", APPROXIMATED,
     "numpy.float is an old name: write float"),
    ("from collections import Iterable\n", "line 2", APPROXIMATED, "collections.abc.Iterable")])
def test_what_python_will_not_do_is_named_with_its_line(node, body, part, status, how):
    body = body if isinstance(body, bytes) else body.encode()
    assert node(b"#!/usr/bin/env python3\n" + body)
    found, = program_findings(node.path.parents[1])
    assert (found.part, found.status) == (part, status) and how in found.how
    assert [found] == list(script_findings(node.path))


@pytest.mark.parametrize("body", [
    b"try:\n    import Queue\nexcept ImportError:\n    import queue\n", b"import rospy, beside\n",
    b"from . import x\n", b"import sys\nsys.path.append('/x')\nimport other\n",
    b"import contextlib\nwith contextlib.suppress(ImportError):\n    import other\n",
    b"import time\nt = time.clock() if hasattr(time, 'clock') else 0\n",
    b"import numpy as np\nif not hasattr(np, 'float'):\n    np.float = float\n",
    "# -*- coding: gbk -*-\nx = '中'\n".encode("gbk"),
    b"import numpy as np\nnp.float32(1)\n", "# 中文\nprint('好')\n".encode()])
def test_what_python_will_do_is_not_named(node, body):
    (node.path.parent / "beside.py").touch()
    assert node(b"#!/usr/bin/env python3\n" + body) == []


def test_modules_of_the_workspace_are_there(tmp_path):
    path = tmp_path / "src/arm/scripts/talk.py"
    for folder in (path.parent, tmp_path / "src/arm_msgs", tmp_path / "src/hand/src/grip"):
        folder.mkdir(parents=True)
    (tmp_path / "src/arm/package.xml").write_text("<package><name>arm_of_mine</name></package>")
    path.write_text("import arm_msgs.msg, arm_of_mine.cfg, grip\nimport nobodys\n")
    assert [found.part for found in script_findings(path)] == ["line 2"]


def test_an_empty_script_is_named(node):
    (_, how), = node(b"")
    assert how == "it is empty, so that nothing starts"


@pytest.mark.parametrize("line, named", [
    (b'image_transport::TransportHints hints("compressed");', True),
    (b'it.subscribe("a", 1, f, this, TransportHints("theora"));', True),
    (b'it.subscribe("a", 1, f, this, TransportHints("raw"));', False),
    (b'TransportHints::fromNode(n);', False)])
def test_a_transport_without_a_plugin_is_named_with_its_line(tmp_path, monkeypatch, line, named):
    monkeypatch.setattr("workspace_needs.check.sources._is_here", lambda package: False)
    (tmp_path / "see.cpp").write_bytes(b"#include <x>\n" + line)
    found = [(finding.where, finding.part) for finding in program_findings(tmp_path)]
    assert found == ([(str(tmp_path / "see.cpp"), "line 2")] if named else [])


def test_a_link_to_nowhere_is_no_source(tmp_path):
    (tmp_path / ".#see.cpp").symlink_to("me@host.1234")  # Emacs's lock
    assert list(program_findings(tmp_path)) == []


def test_the_time_for_a_source_is_linear(tmp_path):
    (tmp_path / "see.cpp").write_text("TransportHints(" * 20_000)
    began = time.process_time()
    assert list(program_findings(tmp_path)) == []
    assert time.process_time() - began < 5  # a minute without bounds


def test_a_pipe_is_not_read(node, tmp_path):
    os.mkfifo(tmp_path / "scripts" / "pipe", 0o755)
    os.mkfifo(tmp_path / "scripts" / "pipe.cpp")
    (tmp_path / "package.xml").write_text("<package/>", encoding="utf-8")
    assert node(b"#!/bin/sh\n") == []
    assert list(_files(tmp_path)) == [tmp_path / "package.xml", node.path]


def test_xacro_files_are_bounded_in_sum(tmp_path, monkeypatch):
    monkeypatch.setattr(parameter_commands, "_taken", [])
    path = tmp_path / "r.xacro"
    path.write_text("<robot name='r'/>", encoding="utf-8")
    assert "robot" in parameter_commands.expanded(path, {}, str)
    monkeypatch.setattr(parameter_commands, "MOST_IN_SUM", sum(parameter_commands._taken))
    with pytest.raises(FormatError, match=r"r.xacro: it is not expanded: those before it took"):
        parameter_commands.expanded(path, {}, str)
