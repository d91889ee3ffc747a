"""What check says of a package's scripts and C++ nodes that will not run."""

import os
import re
import subprocess
import time
from pathlib import Path

import pytest
from workspace_needs.check import parameter_commands, sources
from workspace_needs.check.command import main
from workspace_needs.check.contents import files_of
from workspace_needs.check.findings import HINT, PROBLEM, UNCHECKED, table
from workspace_needs.workspace import _files
from workspaces import NODE, add_files, program_findings, script_findings

from bullet_sim.errors import FormatError
from bullet_sim_ros.interface import ABSENT

# A file is checked in a fork of this process, which must not hold engines or OpenGL of other tests.
pytestmark = pytest.mark.processes


@pytest.fixture
def node(tmp_path):
    """Writes an executable script; what is found in its package."""
    path = tmp_path / "scripts" / "talker.py"
    path.parent.mkdir()

    def write(content: bytes) -> list[tuple[str, str]]:
        path.write_bytes(content)
        path.chmod(0o755)
        return [(found.where, found.how) for found in program_findings(tmp_path)]
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
    b"#!/usr/bin/python\n", b"#!/usr/bin/env python\n",
    b"#!/usr/bin/env python2.7\n", b"#!/usr/bin/env -S A=1 python3 -u\n"])
def test_others_are_not_named(node, content):
    assert node(content) == []


@pytest.mark.parametrize("executable, why", [
    (True, "it has no #!, so that rosrun starts it as a shell script; write "
           "#!/usr/bin/env python3 there"),
    (False, "rosrun does not find it: chmod +x {}, and write #!/usr/bin/env python3 as its first "
            "line")])
def test_a_program_without_a_first_line(tmp_path, executable, why):
    path = add_files(tmp_path, {"scripts/talk.py": NODE.partition("\n")[2]}) / "scripts/talk.py"
    path.chmod(0o755 if executable else 0o644)
    found, = program_findings(tmp_path)
    assert found.how == why.format(path) and [found] == script_findings(path)


def test_what_catkin_starts_itself_needs_no_first_line(node):
    folder = node.path.parents[1]
    (folder / "package.xml").touch()
    (folder / "CMakeLists.txt").write_text(
        "# catkin_install_python(...)\n"
        "catkin_install_python(PROGRAMS scripts/talker.py DESTINATION x)")
    assert node(b"#!/usr/bin/python2.7\n") == []
    node.path.chmod(0o644)
    assert program_findings(folder) == script_findings(node.path) == []
    node.path.write_bytes(b"def f(:\n")
    assert program_findings(folder) == script_findings(node.path) != []
    (folder / "CMakeLists.txt").write_text(
        "# catkin_install_python(PROGRAMS scripts/talker.py)\ninstall(PROGRAMS scripts/talker.py)")
    node.path.write_bytes(b"#!/usr/bin/env python3\n")
    assert ["chmod +x" in found.how for found in program_findings(folder)] == [True]
    (folder / "CMakeLists.txt").write_text(
        "file(GLOB ALL scripts/*.py)\ncatkin_install_python(PROGRAMS ${ALL} DESTINATION ${BIN})")
    assert program_findings(folder) == []


def test_a_script_that_is_not_executable_is_named_with_the_command(node, tmp_path):
    (tmp_path / "package.xml").touch()
    node(NODE.encode())
    node.path.chmod(0o644)
    found, = program_findings(tmp_path)
    assert [found] == script_findings(node.path) and found.status == PROBLEM
    (node.path.parent / "other.py").write_text("from . import (\n    os, talker)\n")
    assert program_findings(tmp_path) == []
    (node.path.parent / "other.py").unlink()
    subprocess.run(found.how.partition("type: ")[2], shell=True, check=True)
    assert program_findings(tmp_path) == []


@pytest.mark.parametrize("body, part, status, how", [
    ("def f(:\n", "line 2", PROBLEM, "Python 3 cannot read it: invalid syntax"),
    ("x = 1\nprint 'hello'\n", "line 3", PROBLEM, "this is Python 2, and only Python 3 is here: "),
    (b"x = 1  # \xd6\xd0\n", "line 2", PROBLEM, "it is not UTF-8; save it as UTF-8"),
    ('if __name__ == "__main__":\n    import nobodys\n', "line 3", ABSENT,
     "Debian has no python3-nobodys"),
    ("return\n", "line 2", PROBLEM, "Python 3 cannot read it: 'return' outside function"),
    ("import moveit_commander\n", "line 2", ABSENT, "module moveit_commander is not here: MoveIt"),
    ("import os, rospyy.msg\n", "line 2", ABSENT, "is rospy meant?"),
    ("class A:\n    from urllib2 import x\n", "line 3", ABSENT, "Python 3 calls it urllib.request"),
    ("import httplib\n", "line 2", ABSENT, "Python 3 calls it http.client")])
def test_what_python_will_not_do_is_named_with_its_line(node, body, part, status, how):
    body = body if isinstance(body, bytes) else body.encode()
    assert node(b"#!/usr/bin/env python3\n" + body)
    found, = program_findings(node.path.parents[1])
    assert (found.part, found.status) == (part, status) and how in found.how
    assert [found] == script_findings(node.path)


@pytest.mark.parametrize("body", [
    b"try:\n    import Queue\nexcept ImportError:\n    import queue\n", b"import rospy, beside\n",
    b"from . import x\n", b"def f():\n    import other\n",
    b"import sys\nsys.path.append('/x')\nimport other\n",
    b"import contextlib\nwith contextlib.suppress(ImportError):\n    import other\n",
    b"import time\nt = time.clock() if hasattr(time, 'clock') else 0\n",
    b"import numpy as np\nfrom collections import Iterable\nnp.float(1)\n",  # said at run time
    "# -*- coding: gbk -*-\nx = '中'\n".encode("gbk"),
    b"import numpy as np\nnp.float32(1)\n", "# 中文\nprint('好')\n".encode()])
def test_what_python_will_do_is_not_named(node, body):
    (node.path.parent / "beside.py").touch()
    assert node(b"#!/usr/bin/env python3\n" + body) == []


@pytest.mark.parametrize("name, text, more, named", [
    ("scripts/talk.py", NODE, {}, True), ("src/talk.py", NODE, {}, True),
    ("src/talk.py", "class A:\n    def f(self):\n        rospy.init_node('n')\n", {}, True),
    ("scripts/talk.py", NODE, {"scripts/node": "#!/usr/bin/env python3\nimport talk\n"}, False),
    ("src/arm/talk.py", NODE, {}, False), ("test/talk.py", NODE, {}, False),
    ("scripts/talk.py", 'if __name__ == "__main__":\n    main()\n', {}, False),
    ("scripts/my talk.py", NODE, {}, True), ("scripts/说话.py", NODE, {}, True),
    ("scripts/env.sh", "#!/bin/sh\n", {}, False),
    ("scripts/env.sh", "#!/bin/sh\n", {"CMakeLists.txt": "install(PROGRAMS scripts/env.sh)"}, True),
    ("tools/talk.py", "main()\n",
     {"launch/a.launch": '<launch><node pkg="arm" type="talk.py" name="n"/></launch>'}, True)])
def test_only_a_program_has_to_be_executable(tmp_path, name, text, more, named):
    path = add_files(tmp_path, {name: text, **more}) / name
    path.chmod(0o644)
    assert ["chmod +x" in each.how for each in program_findings(tmp_path)] == [True] * named


@pytest.mark.parametrize("name", ["README", "LICENSE", "scripts/Makefile", "scripts/data.txt",
                                  "scripts/empty.py", "scripts/{{name}}.py", "docs/conf.py",
                                  "test/unit/bad.py", "src/arm/of_python_2.py"])
def test_where_all_files_are_executable_others_are_not_taken_for_programs(tmp_path, name):
    text = "" if "empty" in name else "from the lab\nimport it as you like\nprint 1\n"
    (add_files(tmp_path, {name: text}) / name).chmod(0o777)
    assert program_findings(tmp_path) == []


def test_a_module_is_read_if_another_needs_it(tmp_path):
    files = {"src/arm/a.py": "print 1\n", "src/arm/b.py": "import nobodys\n", "setup.py": "print 1",
             "own/pyvenv.cfg": "", "own/lib/d.py": "print 1\n"}
    assert program_findings(add_files(tmp_path, files)) == []
    user = tmp_path / "scripts/user.py"
    add_files(tmp_path, {"scripts/user.py": "import sys\nif sys.version:\n    import arm.a\n"})
    assert program_findings(tmp_path) == []
    user.write_text("from arm import a, b\n")
    assert [Path(each.where).name for each in program_findings(tmp_path)] == ["a.py"]


@pytest.mark.parametrize("name", ["scripts/syn.py", "nodes/syn.py", "bin/more/syn.py"])
@pytest.mark.parametrize("first, mode", [("", 0o644), ("", 0o755), (NODE[:23], 0o644)])
@pytest.mark.parametrize("body", ["def f(:\n", "print 'hello'\n"])
def test_a_script_that_python_cannot_read_is_named(tmp_path, name, first, mode, body):
    add_files(tmp_path, {name: first + body, "scripts/a.py": NODE})
    (tmp_path / name).chmod(mode)
    found, = program_findings(tmp_path)
    assert found in script_findings(tmp_path / name) and found.status == PROBLEM
    add_files(tmp_path, {"src/arm/b.py": "print 'after syn'\n"})  # its words are no imports
    assert program_findings(tmp_path) == [found]


def test_a_file_whose_faults_are_not_named_is_not_said_to_work(tmp_path):
    add_files(tmp_path, {"src/arm/of_python_2.py": "print 1\n"})
    assert list(sources.program_findings(tmp_path)) == []
    add_files(tmp_path, {"scripts/a.py": NODE})
    found, = sources.program_findings(tmp_path)
    assert found.part == "scripts and C++ files (1)"


def test_the_error_of_one_script_ends_nothing(node, monkeypatch):
    def fail(*_):
        raise KeyError("x")
    monkeypatch.setattr(sources, "python_findings", fail)
    assert node(NODE.encode()) == [(str(node.path), "it could not be checked: KeyError: 'x'")]
    late, = sources.program_findings(node.path.parent, time.monotonic() - 1)
    assert late.status == UNCHECKED


def test_a_script_that_is_too_large_is_said_to_be_unread(node):
    assert node(b"#!/usr/bin/env python3\n" + b"#" * 2**20) == [
        (str(node.path), "it is not read: it has more than 1 MiB")]


def test_an_empty_script_is_named(node):
    node(b"")
    assert [found.how for found in script_findings(node.path)] == [
        "it is empty, so that nothing starts"]


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
    assert program_findings(tmp_path) == []


def test_the_time_for_a_source_is_linear(tmp_path):
    (tmp_path / "see.cpp").write_text("TransportHints(" * 20_000)
    began = time.process_time()
    assert program_findings(tmp_path) == []
    assert time.process_time() - began < 5  # a minute without bounds


def test_the_time_for_a_packages_scripts_is_linear(tmp_path):
    def seconds(count: int) -> float:
        folder = add_files(tmp_path / str(count), {
            f"scripts/talk_{number}.py": f"{NODE}'''{'word ' * 20_000}'''"
            for number in range(count)})
        began = time.process_time()
        assert program_findings(folder) == []
        return time.process_time() - began

    seconds(5)  # what is read only once
    assert any(seconds(300) < 6 * seconds(100) for _ in range(3))  # 3 times in proportion


def test_a_file_that_cannot_be_read_hides_no_others_faults(tmp_path, monkeypatch):
    add_files(tmp_path, {"scripts/node.py": f"{NODE}import nobodys\n", "CMakeLists.txt": "",
                         "a.launch": "<launch/>", "r.xacro": "<robot/>"})
    read = Path.read_text

    def locked(path, *words):
        if path.suffix in (".txt", ".xml", ".launch", ".xacro"):
            raise PermissionError(13, "Permission denied")
        return read(path, *words)

    monkeypatch.setattr(Path, "read_text", locked)
    assert [found.part for found in program_findings(tmp_path)] == ["line 4"]
    assert files_of(tmp_path) == [tmp_path / "a.launch"]


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


@pytest.mark.parametrize("text, code, words", [
    ("#!/usr/bin/env python3\ndef f(:\n", 1, "PROBLEM       line 2: Python 3 cannot read it: "),
    ("import nobodys\n", 1,
     "NOT THERE     line 1: module nobodys is not here: Debian has no python3-nobodys"),
    ("import rospy\n", 0, "works         first line, syntax and modules"),
    ("import nobodys\ndef f(:\n", 1,
     "PROBLEM       line 2: Python 3 cannot read it: invalid syntax; check it again once this is "
     "mended: what follows is not read")])
def test_a_script_alone(check, text, code, words):
    got, said = check("talk.py", text)
    assert got == code and f"\n  {words}" in said


@pytest.mark.parametrize("name, text, executable, words", [
    ("talk.py", "#!/usr/bin/env python3\n", False,
     "it is not executable, so that rosrun and roslaunch do not find it; type: chmod +x "),
    ("talk.py", "#!/usr/bin/env python3\n", True, ""), ("talk.py", "import rospy\n", False, ""),
    ("scripts/talk.py", "import rospy\n", False, "rosrun does not find it: chmod +x "),
    ("scripts/talk", "import rospy\n", False, "rosrun does not find it: chmod +x ")])
def test_a_script_alone_that_rosrun_may_be_meant_to_find(tmp_path, capsys, name, text, executable,
                                                         words):
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    path.chmod(0o755 if executable else 0o644)
    assert main([str(path)]) == 0
    said = capsys.readouterr().out
    assert ("  hint          line 1: " + words in said) is bool(words) and "works  " in said
    assert said.endswith("all of it will work\n")


def test_a_script_of_a_package_that_is_perhaps_a_program(tmp_path):
    files = {"scripts/a.py": "#!/usr/bin/env python3\n", "scripts/b.py": "import a\n"}
    path = add_files(tmp_path, files) / "scripts/a.py"
    path.chmod(0o644)
    assert script_findings(path) == script_findings(tmp_path / "scripts/b.py") == []
    (tmp_path / "scripts/b.py").unlink()
    assert [found.status for found in script_findings(path)] == [HINT]
    assert program_findings(tmp_path) == []


@pytest.mark.parametrize("text, words", [
    ("#!/usr/bin/env python3\nimport nobodys\n", "NOT THERE     line 2: module nobodys"),
    ("import nobodys\n", "NOT THERE     line 1: module nobodys"),
    ("#!/bin/sh\n", "works         first line\n"),
    ("#!/bin/shh\n", "PROBLEM       line 1: there is no /bin/shh here")])
def test_a_script_without_a_suffix_is_no_robot(check, text, words):
    assert words in check("talk", text)[1]


def test_findings_stand_in_the_order_of_their_lines(check):
    _, said = check("talk.py", "#!/usr/bin/env python3\nimport nobodys\nimport nobodys2\n")
    assert re.findall(r"line (\d)", said) == ["1", "2", "3"]  # not the worst first


@pytest.mark.parametrize("body, said", [
    ("x = (1\n", "'(' 没有闭合"), ("def f\n", "缺少“(”"), ("f() = 1\n", "这里不能给函数调用赋值"),
    ("if x\n    y\n", "缺少“:”"), ("  x\n", "意外的缩进"),
    ("print 1\n", "“print”调用缺少括号"), ("x = “a”\n", "无效字符 “（U+201C）"),
    ("def f(a, a): pass\n", "函数定义中参数“a”重复"),
    ("f'{a b}'\n", "读不懂它：语法错误，可能漏了逗号"),
    ("import numppy\n", "没有叫这个名字的模块；是不是想写 numpy？")])
def test_pythons_errors_are_translated(node, monkeypatch, body, said):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    node(body.encode())
    lines = table(script_findings(node.path))
    assert said in lines and not re.search("[a-z]{3} [a-z]{3}", lines.partition("\n")[2])
