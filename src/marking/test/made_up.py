"""Submissions as a class might hand them in, each with what must be seen in its row of the marks.

    python3 made_up.py FOLDER    writes FOLDER/submissions, all of them, and FOLDER/marking.yaml
"""

from __future__ import annotations

import io
import stat
import sys
import tarfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import yaml

LESSON = (Path(__file__).resolve().parents[2] / "learning_topic" / "scripts" /
          "05follower_proporation.py").read_text(encoding="utf-8").replace("1 / 1000", "3 / 1000")
CAMERA = [640, 480]  # px, a third of the width that the lesson's gain is for
SLOW = LESSON.replace("SPEED = 0.15", "SPEED = 0.07")
LOST = LESSON.replace("STEER_GAIN = 3", "STEER_GAIN = -3").replace(
    "command = Twist()", "command = Twist()\n        command.linear.x = SPEED")
STANDS = LESSON.replace("SPEED = 0.15", "SPEED = 0.0").replace("3 / 1000", "0.0")
RULES = Path(__file__).resolve().parents[1] / "config" / "marking.yaml"

# Before the lesson's own main: what else the program does, once the car drives.
AFTER_START = '''
import threading
def _later():
    while not rospy.rostime.is_rostime_initialized() or rospy.get_time() < 1.0:
        time.sleep(0.05)
    {act}
threading.Thread(target=_later, daemon=True).start()
main()
'''


def also(act: str, imports: str = "") -> str:
    """The lesson, which besides does this."""
    head, _, _ = LESSON.rpartition('if __name__ == "__main__":')
    return head + imports + "\n" + AFTER_START.format(act=act.replace("\n", "\n    "))


def call(service: str, kind: str, arguments: str = "") -> str:
    return also(f"rospy.ServiceProxy({service!r}, {kind})({arguments})",
                "from gazebo_msgs.srv import *\nfrom gazebo_msgs.msg import *\n"
                "from std_srvs.srv import Empty\nfrom geometry_msgs.msg import *\n")


def publish(topic: str, kind: str, module: str) -> str:
    return also(f"p = rospy.Publisher({topic!r}, {kind}, queue_size=1)\n"
                f"time.sleep(0.3)\np.publish({kind}())", f"from {module} import {kind}")


def slave_api(method: str) -> str:
    """A call to the simulator's node itself, past the master."""
    return also("import rosgraph, xmlrpc.client\n"
                "node = rosgraph.Master('/x').lookupNode('/gazebo')\n"
                f"xmlrpc.client.ServerProxy(node).{method}")


# Twists of 1 m/s from a socket, as of a publisher that never registers with the master.
MADE_UP_PUBLISHER = also("""import socket, struct, xmlrpc.client
from xmlrpc.server import SimpleXMLRPCServer
def serve():
    while True:
        hearer, _ = topic.accept()
        hearer.recv(4096)
        fields = ['type=geometry_msgs/Twist', 'md5sum=' + Twist._md5sum, 'callerid=/gazebo']
        header = b''.join(struct.pack('<I', len(f)) + f.encode() for f in fields)
        hearer.sendall(struct.pack('<I', len(header)) + header)
        while True:
            hearer.sendall(struct.pack('<I6d', 48, 1.0, 0, 0, 0, 0, 0))
            time.sleep(0.01)
topic = socket.create_server(('127.0.0.1', 0))
threading.Thread(target=serve, daemon=True).start()
slave = SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False)
slave.register_function(lambda *_: (1, '', ['TCPROS', *topic.getsockname()]), 'requestTopic')
threading.Thread(target=slave.serve_forever, daemon=True).start()
node = rospy.get_master().lookupNode('/gazebo')[2]
me = 'http://127.0.0.1:%d/' % slave.server_address[1]
xmlrpc.client.ServerProxy(node).publisherUpdate('/master', '/cmd_vel', [me])""")
# A service's port is asked without a word to the master.
STRAIGHT_CALL = also("""import rosgraph.network, socket, struct
uri = rospy.get_master().lookupService('/gazebo/set_logger_level')[2]
host, _, port = uri.removeprefix('rosrpc://').partition(':')
call = socket.create_connection((host, int(port)))
rosgraph.network.write_ros_handshake_header(call, {
    'service': '/gazebo/set_logger_level', 'md5sum': '*', 'callerid': '/judge'})
call.recv(4096)
call.sendall(struct.pack('<3I', 8, 0, 0))
print(call.recv(4096), flush=True)""")
# A second node that is gone before anybody could connect to it: clumsy, but allowed.
BRIEF_PUBLISHER = also("""master = rospy.get_master()
for _ in range(20):
    master.target.registerPublisher('/brief', '/cmd_vel', 'geometry_msgs/Twist', 'http://127.0.0.1:9/')
    master.target.unregisterPublisher('/brief', '/cmd_vel', 'http://127.0.0.1:9/')""")


# The lesson with a command in a loop of its own, as on a robot, not in answer to an image.
_KEEPS, _, _ = LESSON.replace(
    "self.cmd_vel_pub.publish(command)", "self.command = command").replace(
    "        self.bridge =", "        self.command = Twist()\n        self.bridge =").rpartition(
    "    rospy.spin()")
_SEND = "follower.cmd_vel_pub.publish(follower.command)"
RATE_LOOP = _KEEPS + f'''    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        {_SEND}
        rate.sleep()


main()
'''
TIMER = _KEEPS + f'''    rospy.Timer(rospy.Duration(0.1), lambda _: {_SEND})
    rospy.spin()


main()
'''
SLEEPS_FIRST = LESSON.replace(
    "follower = Follower()", "rospy.sleep(1.0)\n    follower = Follower()")
IN_REAL_TIME = "real time"

CALLED, PUBLISHED = "it called ", "it published "
# Student: (program, what the row says, least points, most points)
PROGRAMS: dict[str, tuple[str, str, float, float]] = {
    "good": (LESSON, "", 85, 100),
    "张伟_2023001": (LESSON, "", 85, 100),
    "王 小明: $(env HOME)": (LESSON, "", 85, 100),
    "windows_lines": (LESSON.replace("\n", "\r\n"), "", 85, 100),
    "wrong_shebang": (LESSON.replace("/usr/bin/env python3", "/opt/python2"), "", 85, 100),
    "reads_pose": (call("/gazebo/get_model_state", "GetModelState",
                        "'turtlebot3_waffle', 'world'"), "", 85, 100),
    "rate_loop": (RATE_LOOP, IN_REAL_TIME, 80, 100),
    "timer": (TIMER, IN_REAL_TIME, 80, 100),
    "sleeps_first": (SLEEPS_FIRST, IN_REAL_TIME, 80, 100),
    "slow": (SLOW, "on average", 70, 95),
    "lost": (LOST, "left the course", 0, 30),
    "stands": (STANDS, "never moved", 0, 15),
    "crash_at_once": ("raise ValueError('broken')\n", ".py, line 1: ValueError: broken", 0, 0),
    "crash_later": (also("import os\nos._exit(3)"), "exit code 3", 0, 0),
    "python2": ("x = 1\nprint 'hello'\n", ".py, line 2: SyntaxError", 0, 0),
    "tabs": ("if True:\n\tx = 1\n        y = 2\n", ".py, line 3: TabError", 0, 0),
    "empty": ("", "empty.py is empty", 0, 0),
    "spaces": ("\ufeff \r\n\t\n", "spaces.py is empty", 0, 0),
    "comments": ("#!/usr/bin/python3\n  # my follower\n", "comments.py has only comments", 0, 0),
    "missing_module": ("import tensorflow\n", "No module named 'tensorflow'", 0, 0),
    "no_node": ("import time\ntime.sleep(1000)\n", "it had not subscribed", 0, 0),
    "sets_state": (call("/gazebo/set_model_state", "SetModelState",
                        "ModelState(model_name='turtlebot3_waffle')"),
                   CALLED + "/gazebo/set_model_state", 0, 0),
    "sets_link": (call("/gazebo/set_link_state", "SetLinkState", "LinkState()"),
                  CALLED + "/gazebo/set_link_state", 0, 0),
    "spawns": (call("/gazebo/spawn_sdf_model", "SpawnModel", "'x', '<sdf/>', '', Pose(), ''"),
               CALLED + "/gazebo/spawn_sdf_model", 0, 0),
    "deletes": (call("/gazebo/delete_model", "DeleteModel", "'ground_plane'"),
                CALLED + "/gazebo/delete_model", 0, 0),
    "pauses": (call("/gazebo/pause_physics", "Empty"), CALLED + "/gazebo/pause_physics", 0, 0),
    "unpauses": (call("/gazebo/unpause_physics", "Empty"),
                 CALLED + "/gazebo/unpause_physics", 0, 0),
    "resets": (call("/gazebo/reset_world", "Empty"), CALLED + "/gazebo/reset_world", 0, 0),
    "physics": (call("/gazebo/set_physics_properties", "SetPhysicsProperties"),
                CALLED + "/gazebo/set_physics_properties", 0, 0),
    "wrench": (call("/gazebo/apply_body_wrench", "ApplyBodyWrench"),
               CALLED + "/gazebo/apply_body_wrench", 0, 0),
    "state_topic": (publish("/gazebo/set_model_state", "ModelState", "gazebo_msgs.msg"),
                    PUBLISHED + "/gazebo/set_model_state", 0, 0),
    "odom": (publish("/odom", "Odometry", "nav_msgs.msg"), PUBLISHED + "/odom", 0, 0),
    "clock": (publish("/clock", "Clock", "rosgraph_msgs.msg"), PUBLISHED + "/clock", 0, 0),
    "images": (publish("/camera/rgb/image_raw", "Image", "sensor_msgs.msg"),
               PUBLISHED + "/camera/rgb/image_raw", 0, 0),
    "parameter": (also("rospy.set_param('/use_sim_time', False)"),
                  "it changed the parameter /use_sim_time", 0, 0),
    "kills_simulator": (slave_api("shutdown('/x', 'end')"),
                        "it asked the node /gazebo to end", 0, 0),
    "made_up_publisher": (MADE_UP_PUBLISHER, "it fed /gazebo a publisher of /cmd_vel that the "
                          "master does not know", 0, 0),
    "straight_call": (STRAIGHT_CALL, CALLED + "/gazebo/set_logger_level", 0, 0),
    "brief_publisher": (BRIEF_PUBLISHER, "", 85, 100),
    "sends_parameter": (slave_api("paramUpdate('/master', '/use_sim_time', False)"),
                        "it sent /gazebo the parameter /use_sim_time", 0, 0),
    "takes_name_quietly": (also(
        "rospy.get_master().target.subscribeParam('/gazebo', 'http://127.0.0.1:9/', '/x')"),
        "it asked the node /gazebo to end", 0, 0),
    "kills_master": (also("rospy.get_master().target.shutdown('/x', 'end')"),
                     "it ended a node of the course", 0, 0),
    "kills_launch": (also("import xmlrpc.client\n"
                          "uri = next(iter(rospy.get_param('/roslaunch/uris').values()))\n"
                          "xmlrpc.client.ServerProxy(uri).log("
                          "'x', 8, '[gazebo-1] process has died [pid 1, exit code 1]')"),
                     "it sent roslaunch a report", 0, 0),
    "unregisters": (also(
        "import rosgraph\nm = rosgraph.Master('/gazebo')\n"
        "m.unregisterPublisher('/odom', m.lookupNode('/gazebo'))"), "the node /gazebo", 0, 0),
    "takes_name": (LESSON.replace('init_node("follower", anonymous=True)', 'init_node("gazebo")'),
                   "the node /gazebo", 0, 0),
    "fork_bomb": ("import os\nwhile True:\n    try:\n        os.fork()\n    except OSError:\n"
                  "        pass\n", "more than 50 processes", 0, 0),
    "endless_import": ("while True:\n    pass\n", "it had not subscribed", 0, 0),
    "much_output": ("while True:\n    print('x' * 100000)\n", "it printed more than", 0, 0),
    "much_memory": ("x = []\nwhile True:\n    x.append(bytearray(10**8))\n", "MemoryError", 0, 0),
    "many_take_memory": ("import os, time\nfor _ in range(20):\n    if not os.fork():\n"
                         "        x = bytearray(b'x') * 150_000_000\n        break\n"
                         "time.sleep(1000)\n", "of memory", 0, 0),
    "fills_disk": ("with open('/tmp/x', 'wb') as f:\n    while True:\n"
                   "        f.write(b'x' * 10**6)\n", "OSError", 0, 0),
    "deaf_to_signals": ("import signal, time\nfor n in (1, 2, 3, 15):\n"
                        "    signal.signal(n, signal.SIG_IGN)\ntime.sleep(1000)\n",
                        "it had not subscribed", 0, 0),
    "looks_around": ("import os, glob\n"
                     "seen = [p for p in glob.glob('/*/*') + glob.glob('/home/*/*')\n"
                     "        if 'case.json' in p or 'marks' in p or 'state.jsonl' in p]\n"
                     "pids = [p for p in os.listdir('/proc') if p.isdigit()]\n"
                     "open('/home/student/x', 'w').write('x')\n"
                     "try:\n    open(__file__, 'a')\n    seen.append('submission is writable')\n"
                     "except OSError:\n    pass\n"
                     "raise RuntimeError(f'seen {seen} of {len(pids) < 6}')\n",
                     "seen [] of True", 0, 0),
    "kills_all": ("import os, signal\nos.kill(-1, signal.SIGKILL)\n", "the program ended", 0, 0),
}


def _zip(entries: dict[str, str | bytes], change: Callable[[zipfile.ZipInfo], None] | None = None
         ) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            info = zipfile.ZipInfo(name)
            info.compress_type = zipfile.ZIP_DEFLATED
            if change:
                change(info)
            archive.writestr(info, data)
    return made.getvalue()


def _as_link(info: zipfile.ZipInfo) -> None:
    info.external_attr = (stat.S_IFLNK | 0o777) << 16


def _tar(entries: dict[str, str], link: str = "") -> bytes:
    made = io.BytesIO()
    with tarfile.open(fileobj=made, mode="w:gz") as archive:
        for name, text in entries.items():
            info = tarfile.TarInfo(name)
            info.size = len(text.encode())
            archive.addfile(info, io.BytesIO(text.encode()))
        if link:
            info = tarfile.TarInfo("link.py")
            info.type, info.linkname = tarfile.SYMTYPE, link
            archive.addfile(info)
    return made.getvalue()


# File: (bytes, what the row says, least points, most points)
ARCHIVES: dict[str, tuple[bytes, str, float, float]] = {
    "李娜.zip": (_zip({"作业/巡线 follower.py": LESSON}), "", 85, 100),
    "package.tar.gz": (_tar({
        "pkg/package.xml": "<package/>", "pkg/scripts/follower.py": "import helper\n" + LESSON,
        "pkg/scripts/helper.py": "X = 1\n"}), "", 85, 100),
    "zip_bomb.zip": (_zip({"a.py": b"\0" * (65 << 20)}), "more than 64 MiB", 0, 0),
    "traversal.zip": (_zip({"../../evil.py": LESSON}), "out of the archive", 0, 0),
    "link.zip": (_zip({"follower.py": "/etc/passwd"}, _as_link), "symbolic link", 0, 0),
    "link_tar.tar.gz": (_tar({"follower.py": LESSON}, "/etc/passwd"), "is a link", 0, 0),
    "broken.zip": (b"PK\3\4 no zip", "cannot be unpacked", 0, 0),
    "empty.zip": (_zip({"readme.txt": "hi"}), "no Python program", 0, 0),
    "two.zip": (_zip({"a.py": LESSON, "b.py": LESSON}), "which program drives?", 0, 0),
    "report.docx": (b"PK", "not a Python file", 0, 0),
}


def wrong_rows(rows: Sequence[Mapping[str, str]],
               expected: Mapping[str, tuple[str, float, float]]) -> list[str]:
    """A line for each row of marks.csv that is not as designed."""
    found = {row["student"]: row for row in rows}
    wrong = [f"{student}: {'no such row' if student in expected else 'a row too many'}"
             for student in sorted(set(found) ^ set(expected))]
    for student in sorted(set(found) & set(expected)):
        (says, least, most), row = expected[student], found[student]
        if says not in f"{row['why points were lost']}; {row['note']}" or not (
                least <= float(row["points"]) <= most):
            wrong.append(f"{student}: {row['points']} points, {row['why points were lost']} "
                         f"{row['note']}; expected {least:g} to {most:g} and {says!r}")
    return wrong


def write_rules(path: Path, **limits: float) -> Path:
    """The shipped rules with the small camera and these limits."""
    rules = yaml.safe_load(RULES.read_text(encoding="utf-8"))
    rules["limits"] |= limits
    path.write_text(yaml.safe_dump({**rules, "camera": CAMERA}), encoding="utf-8")
    return path


def write(folder: Path, names: set[str] | None = None) -> dict[str, tuple[str, float, float]]:
    """Write these submissions, or all; returns for each student what its row must say."""
    folder.mkdir(parents=True, exist_ok=True)
    expected = {}
    for student, (program, *row) in PROGRAMS.items():
        if names is None or student in names:
            (folder / f"{student}.py").write_text(program, encoding="utf-8", newline="")
            expected[student] = tuple(row)
    for name, (data, *row) in ARCHIVES.items():
        student = name if name.endswith(".docx") else name.partition(".")[0]
        if names is None or name in names:
            (folder / name).write_bytes(data)
            expected[student] = tuple(row)
    return expected


if __name__ == "__main__":
    print(len(write(Path(sys.argv[1]) / "submissions")), "submissions")
    write_rules(Path(sys.argv[1]) / "marking.yaml")
