"""check_network: each wrong setting is named, and nothing else."""

import dataclasses
import re
import subprocess
import sys
import threading
from pathlib import Path
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from nav_demo.network import asking
from nav_demo.network.answers import (
    Node,
    check_callback,
    check_clock,
    check_latency,
    check_master_answer,
    check_nodes,
)
from nav_demo.network.settings import (
    Surroundings,
    advertised_name,
    check_master,
    check_own_name,
    split_uri,
)
from terminal_language.catalogue import read_catalogue

SCRIPT = Path(__file__).resolve().parents[1] / "scripts" / "check_network"
KNOWN = {"localhost": "127.0.0.1", "robot": "10.0.0.2", "laptop": "10.0.0.1", "debian": "127.0.1.1",
         "10.0.0.1": "10.0.0.1", "10.0.0.2": "10.0.0.2", "10.0.0.9": "10.0.0.9"}
AROUND = Surroundings(  # the laptop; the robot is another machine
    addresses_of=lambda name: [KNOWN[name]] if name in KNOWN else [],
    is_mine=lambda address: address in ("10.0.0.1", "127.0.0.1", "127.0.1.1"),
    address_towards=lambda _: "10.0.0.1", own_name="debian")
ROBOT = {"ROS_MASTER_URI": "http://robot:11311"}


@pytest.mark.parametrize("uri, place", [
    ("http://robot:11311", ("robot", 11311)), ("http://robot:11311/", ("robot", 11311)),
    ("robot:11311", None), ("http://robot", None), ("https://robot:11311", None),
    ("http://robot:eleven", None), ("http://:11311", None), ("http://robot:11311/x", None)])
def test_uris(uri, place):
    assert split_uri(uri) == place


@pytest.mark.parametrize("environment, words", [
    ({}, "ROS_MASTER_URI is not set"),
    ({"ROS_MASTER_URI": "robot:11311"}, "'robot:11311', and not of the form http://HOST:PORT"),
    ({"ROS_MASTER_URI": "http://rebot:11311"}, "'rebot', and this machine knows no address")])
def test_master_uri(environment, words):
    (finding,) = check_master(environment, AROUND)
    assert words in str(finding) and "ROS_MASTER_URI=http://" in finding.remedy


def test_a_right_master_uri():
    assert check_master(ROBOT, AROUND) == []


@pytest.mark.parametrize("own, words", [
    ({"ROS_HOSTNAME": "localhost"}, "ROS_HOSTNAME is 'localhost', which is 127.0.0.1"),
    ({}, "hostname is 'debian', which is 127.0.1.1: the master is on another machine (robot)"),
    ({"ROS_IP": "10.0.0.9"}, "ROS_IP is '10.0.0.9', which is 10.0.0.9, no address of this machine"),
    ({"ROS_IP": "laptop"}, "ROS_IP is 'laptop', and that is no IP address"),
    ({"ROS_HOSTNAME": "lap"}, "not even this machine knows its address"),
    ({"ROS_HOSTNAME": "http://laptop"}, "no http:// and no port")])
def test_own_name(own, words):
    (finding,) = check_own_name(ROBOT | own, AROUND)
    assert words in str(finding)
    assert finding.remedy == "export ROS_IP=10.0.0.1; unset ROS_HOSTNAME"


def test_of_two_names_one_has_no_effect():
    (finding,) = check_own_name(ROBOT | {"ROS_HOSTNAME": "laptop", "ROS_IP": "10.0.0.9"}, AROUND)
    assert "no effect" in finding.wrong and finding.remedy == "unset ROS_IP"


@pytest.mark.parametrize("environment", [
    ROBOT | {"ROS_IP": "10.0.0.1"}, ROBOT | {"ROS_HOSTNAME": "laptop"},
    {"ROS_MASTER_URI": "http://localhost:11311"},
    {"ROS_MASTER_URI": "http://localhost:11311", "ROS_HOSTNAME": "localhost"}])
def test_right_names(environment):
    assert check_own_name(environment, AROUND) == []


def test_which_name_others_are_told():
    both = {"ROS_HOSTNAME": "laptop", "ROS_IP": "10.0.0.1"}
    assert advertised_name(both, "debian") == ("laptop", "ROS_HOSTNAME")
    assert advertised_name({"ROS_IP": "10.0.0.1"}, "debian") == ("10.0.0.1", "ROS_IP")
    assert advertised_name({}, "debian") == ("debian", "hostname")


@pytest.mark.parametrize("node, words", [
    (Node("/a", "http://robot:1", "", "silence"), "/a: registered as 'robot', and this machine"),
    (Node("/a", "http://localhost:1", "127.0.0.1", "refused"), "leads each machine to itself"),
    (Node("/a", "http://robot:1", "10.0.0.2", "refused"), "nobody listens there any more"),
    (Node("/a", "http://robot:1", "10.0.0.2", "silence"), "no answer at robot:1"),
    (Node("/a", "rosrpc://x", "", "silence"), "no address")])
def test_nodes(node, words):
    (finding,) = check_nodes([node], master_is_here=False)
    assert words in str(finding)


def test_nodes_of_the_same_mistake_are_one_line():
    nodes = [Node(f"/n{i}", f"http://localhost:{i + 1}", "127.0.0.1", "refused") for i in range(5)]
    (finding,) = check_nodes(nodes, master_is_here=False)
    assert "/n0, /n1, /n2 and 2 more nodes" in finding.wrong


def test_nodes_that_answer_are_right():
    nodes = [Node("/a", "http://robot:1", "10.0.0.2", "yes"),
             Node("/b", "http://localhost:1", "127.0.0.1", "yes")]
    assert check_nodes(nodes, master_is_here=True) == []
    dead = Node("/c", "http://localhost:2", "127.0.0.1", "refused")
    (finding,) = check_nodes([dead], master_is_here=True)
    assert finding.remedy == "rosnode cleanup"


@pytest.mark.parametrize("answer, words", [
    ("refused", "there is no master, or it listens to its own machine alone"),
    ("silence", "no answer from"), ("other", "not a ROS master")])
def test_master_answers(answer, words):
    (finding,) = check_master_answer(answer, "robot", 11311)
    assert words in finding.wrong and "robot" in finding.remedy


def test_right_answers():
    assert check_master_answer("yes", "robot", 11311) == []
    assert check_callback(True, "laptop", "robot", "10.0.0.1") == []
    assert check_latency([1, 2, 3], "robot") == []
    assert check_clock(True, True, 100.0, "robot") == []
    assert check_clock(False, False, 1.4, "robot") == []
    assert check_clock(False, False, None, "robot") == []


def test_callback_latency_and_clocks():
    (finding,) = check_callback(False, "debian", "robot", "10.0.0.1")
    assert "'debian'" in finding.wrong and "ROS_IP=10.0.0.1" in finding.remedy
    (finding,) = check_latency([1, 150, 160], "robot")
    assert "150 ms" in finding.wrong
    (finding,) = check_clock(True, False, None, "robot")
    assert "nobody publishes /clock" in finding.wrong
    (finding,) = check_clock(False, True, None, "robot")
    assert "/use_sim_time is not true" in finding.wrong
    assert "60 s behind" in check_clock(False, False, -60.2, "robot")[0].wrong
    assert "60 s ahead" in check_clock(False, False, 60.2, "robot")[0].wrong


def test_without_a_network_nobody_is_told_to_call_himself_localhost():
    alone = dataclasses.replace(AROUND, address_towards=lambda _: "127.0.0.1")
    (finding,) = check_own_name(ROBOT, alone)
    assert "network of robot" in finding.remedy and "ROS_IP" not in finding.remedy


def findings():
    """One of each kind."""
    own = ({"ROS_HOSTNAME": "localhost"}, {}, {"ROS_IP": "10.0.0.9"}, {"ROS_IP": "laptop"},
           {"ROS_HOSTNAME": "lap"}, {"ROS_HOSTNAME": "http://laptop"},
           {"ROS_HOSTNAME": "laptop", "ROS_IP": "10.0.0.9"})
    places = (("http://robot:1", ""), ("http://localhost:1", "127.0.0.1"), ("rosrpc://x", ""),
              ("http://robot:1", "10.0.0.2"))
    nodes = [Node(f"/n{at}", uri, address, answer) for answer in ("refused", "silence")
             for at, (uri, address) in enumerate(places)]
    yield from (each for uri in ("", "robot:1", "http://rebot:1")
                for each in check_master({"ROS_MASTER_URI": uri}, AROUND))
    yield from (each for names in own for each in check_own_name(ROBOT | names, AROUND))
    yield from (each for node in nodes for each in check_nodes([node] * 5, False))
    yield from (each for host in ("robot", "localhost")
                for answer in ("refused", "silence", "other")
                for each in check_master_answer(answer, host, 11311))
    yield from check_callback(False, "debian", "robot", "10.0.0.1")
    yield from check_latency([200], "robot")
    yield from (each for clock in ((True, False, None), (False, True, None), (False, False, -60),
                                   (False, False, 60)) for each in check_clock(*clock, "robot"))


def test_in_chinese_no_line_is_half_english():
    chinese = read_catalogue("zh_CN")
    for finding in findings():
        sentence = chinese.translate(str(finding)).partition("请输入：")[0]
        left = re.findall(r"\b(?!ROS )[A-Za-z]{2,} [a-z]{2,}|WRONG|Type", sentence)
        assert sentence.startswith("错误") and not left, chinese.translate(str(finding))


@pytest.fixture
def http_server():
    """Something that answers XML-RPC as a master's getPid does, or not at all like it."""
    server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
    server.register_function(lambda caller: [1, "", 42], "getPid")
    thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    yield server
    server.shutdown()
    server.server_close()


def test_asking(http_server):
    peer = asking.Peer(f"http://127.0.0.1:{http_server.server_address[1]}")
    assert peer.answer() == "yes"
    assert abs(peer.clock_ahead()) < 2
    assert len(peer.calls_ms(3)) == 3
    http_server.funcs["getPid"] = lambda caller: "hello"
    assert peer.answer() == "other"
    assert asking.is_mine("127.0.0.1") and not asking.is_mine("192.0.2.1")
    assert asking.addresses_of("localhost") == ["127.0.0.1"]
    assert asking.addresses_of("no-such-host.invalid") == []


def test_nobody_listens():
    with asking.socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))  # bound, but it does not listen
        port = taken.getsockname()[1]
        assert asking.Peer(f"http://127.0.0.1:{port}").answer() == "refused"


def test_the_command(tmp_path):
    """Without a master: one line that says so, and exit code 1."""
    with asking.socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        environment = {**asking_environment(), "ROS_MASTER_URI": f"http://localhost:{port}"}
        done = subprocess.run([sys.executable, SCRIPT], env=environment, text=True,
                              capture_output=True, timeout=30)
    assert done.returncode == 1 and not done.stderr
    assert f"nobody listens at localhost:{port}" in done.stdout


def asking_environment():
    """PYTHONPATH of this package, and no ROS settings but those the test gives."""
    return {"PYTHONPATH": str(SCRIPT.parents[1] / "src"), "PATH": "/usr/bin:/bin",
            "ROS_HOSTNAME": "localhost"}
