"""Who gets in: token, Host and Origin, and what a page without control may do."""

import asyncio
import errno

import aiohttp
import pytest
from aiohttp import web
from sim_viewer import options as node_options
from sim_viewer import registry
from sim_viewer.options import Options
from sim_viewer.registry import Node
from sim_viewer.server import NoPort, Server
from sim_viewer.urls import further_urls, page_url
from yarl import URL

PATHS = ("/", "/main.js", "/ws")


def test_with_a_token_nothing_is_served_to_who_does_not_know_it(visit):
    async def story(http, port):
        for path in PATHS:
            for asked in ("", "?token=", "?token=wrong", "?token=secretx"):
                async with http.get(path + asked) as answer:
                    assert answer.status == 403, path + asked
                    assert "token" in await answer.text()
        with pytest.raises(aiohttp.WSServerHandshakeError):
            await http.ws_connect("/ws?token=wrong")
    visit(story, token="secret")


def test_who_showed_the_token_once_gets_all_files_of_the_page(visit):
    async def story(http, port):
        async with aiohttp.ClientSession(
                f"http://127.0.0.1:{port}",
                cookie_jar=aiohttp.CookieJar(unsafe=True)) as browser:  # numbers have cookies too
            async with browser.get("/?token=secret") as answer:
                assert answer.status == 200
            async with browser.get("/main.js") as answer:
                assert answer.status == 200
        async with http.ws_connect("/ws?token=secret") as link:
            assert await ask(link, "about")
    visit(story, token="secret")


def test_a_token_is_made_where_others_can_reach_the_page(monkeypatch):
    given = {"~address": "0.0.0.0"}
    monkeypatch.setattr(node_options.rospy, "get_param", lambda name, *default: (
        given.get(name, *default)))
    first, second = node_options.read_options(), node_options.read_options()
    assert len(first.token) >= 16
    assert first.token != second.token
    given["~address"] = "127.0.0.1"
    assert node_options.read_options().token == ""
    given.update({"~address": "0.0.0.0", "~token": "ours"})
    assert node_options.read_options().token == "ours"


@pytest.mark.parametrize(("headers", "status"), [
    ({}, 200),
    ({"Host": "localhost:{port}"}, 200),
    ({"Origin": "http://127.0.0.1:{port}"}, 200),
    ({"Host": "evil.example"}, 403),
    ({"Host": "evil.example:{port}"}, 403),
    ({"Host": "127.0.0.1.evil.example:{port}"}, 403),
    ({"Host": ""}, 403),
    ({"Host": "[:{port}"}, 403),
    ({"Origin": "http://evil.example"}, 403),
    ({"Origin": "http://127.0.0.1:1"}, 403),
    ({"Origin": "null"}, 403),
    ({"Origin": "http://["}, 403),
    ({"Host": "[::1]:{port}"}, 200),
    ({"Host": "[::1]:{port}", "Origin": "http://[::1]:{port}"}, 200),
    ({"Host": "evil.example@127.0.0.1:{port}"}, 403),
])
def test_a_foreign_page_gets_nothing(visit, headers, status):
    async def story(http, port):
        sent = {name: value.format(port=port) for name, value in headers.items()}
        for path in PATHS[:2]:
            async with http.get(path, headers=sent) as answer:
                assert answer.status == status, path
        if status == 200:
            async with http.ws_connect("/ws", headers=sent) as link:
                assert await ask(link, "about")
        else:
            with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                await http.ws_connect("/ws", headers=sent)
            assert refused.value.status == 403
    visit(story)


def test_no_other_page_may_frame_this_one(visit):
    async def story(http, port):
        for path in PATHS[:2]:
            async with http.get(path) as answer:
                assert "frame-ancestors 'self'" in answer.headers["Content-Security-Policy"]
    visit(story)


@pytest.mark.parametrize("path", ["/../package.xml", "/%2e%2e/package.xml", "/..%2fpackage.xml",
                                  "/vendor/../../package.xml", "//etc/passwd", "/%00",
                                  "/" + "a" * 4000])
def test_no_path_leads_out_of_the_page(visit, path):
    async def story(http, port):
        async with http.get(URL(f"http://127.0.0.1:{port}{path}", encoded=True)) as answer:
            assert answer.status in (400, 403, 404)
            if answer.status == 404:
                assert answer.headers["X-Content-Type-Options"] == "nosniff"
    visit(story)


@pytest.mark.parametrize("cookie", ["\\xff", '"\\377"', "\u2603"])
def test_a_token_that_is_no_text_is_wrong(visit, cookie):
    async def story(http, port):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(f"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nCookie: sim_viewer_{port}=".encode()
                     + cookie.encode().decode("unicode_escape").encode("latin-1", "replace")
                     + b"\r\n\r\n")
        assert b" 403 " in await reader.readline()
        writer.close()
    visit(story, token="secret")


def test_two_pages_of_one_machine_keep_their_tokens(visit):
    async def story(http, port):
        other = Server(Node(Options(port=port, token="other"), asyncio.get_running_loop()))
        second = await other.start()  # the first has the port
        async with aiohttp.ClientSession(
                cookie_jar=aiohttp.CookieJar(unsafe=True)) as browser:
            for at, token in ((port, "secret"), (second, "other")):
                async with browser.get(f"http://127.0.0.1:{at}/?token={token}") as answer:
                    assert answer.status == 200
            for at in (port, second):
                async with browser.get(f"http://127.0.0.1:{at}/main.js") as answer:
                    assert answer.status == 200, at
        await other.close()
    visit(story, token="secret")


def test_the_printed_addresses_can_be_typed_elsewhere():
    addresses = ["127.0.0.1", "192.168.1.5", "fe80::1", "2001:db8::5"]
    everywhere = Options(address="0.0.0.0", token="a+b")
    assert page_url(everywhere, 8081) == "http://127.0.0.1:8081/?token=a%2Bb"
    assert further_urls(everywhere, 8081, addresses) == ["http://192.168.1.5:8081/?token=a%2Bb"]
    assert further_urls(Options(address="::"), 8081, addresses)[1] == "http://[2001:db8::5]:8081/"
    assert further_urls(Options(address="192.168.1.5"), 8081, addresses) == []


def test_without_control_every_operation_that_changes_something_is_refused(visit):
    async def story(http, port):
        async with http.ws_connect("/ws") as link:
            assert (await ask(link, "about"))["data"]["control"] is False
            for operation in changing:
                answer = await ask(link, operation.name)
                assert not answer["ok"]
                assert "control:=true" in answer["error"], operation.name
    registry.load_all()
    changing = [one for one in registry._operations.values() if one.control]
    assert {"drive", "drive_open", "drive_release"} <= {one.name for one in changing}
    visit(story, control=False)


async def ask(link, op, **args):
    await link.send_json({"id": 7, "op": op, **args})
    return await link.receive_json(timeout=60)


def test_without_a_master_every_question_says_so(visit):
    async def story(http, port):
        async with http.ws_connect("/ws") as link:
            for op, args in (("drive_topics", {}), ("parameters", {}), ("services", {}),
                             ("image_topics", {}), ("drive_open", {}), ("pause", {}),
                             ("watch", {"what": "echo", "args": {"topic": "/scan"}})):
                answer = await ask(link, op, **args)
                assert "the ROS master does not answer" in answer["error"], op
    visit(story, control=True)


def test_a_port_of_roots_is_named(monkeypatch):
    async def refused(_site):
        raise PermissionError(errno.EACCES, "Permission denied")

    async def start():
        server = Server(Node(Options(port=80), asyncio.get_running_loop()))
        try:
            return await server.start()
        finally:
            await server.close()

    monkeypatch.setattr(web.TCPSite, "start", refused)
    with pytest.raises(NoPort, match="port 80 is root's; give one from 1024 with port:="):
        asyncio.run(start())
