"""The page in English and Chinese: what its server says, and its tabs' names in the README."""

import re
from pathlib import Path

import pytest
from sim_viewer import registry
from sim_viewer.registry import Refused
from sim_viewer.tools.paced import Paced
from terminal_language.catalogue import read_catalogue

PACKAGE = Path(__file__).resolve().parent.parent
TITLE = re.compile(r'export const title = (?:t\("([^"]+)", "([^"]+)"\)|"([^"]+)")')


def titles() -> list[tuple[str, str]]:
    """Each tab's title in English and Chinese, in their order."""
    names = re.findall(r'"\./(.*\.js)"', (PACKAGE / "web/tabs.js").read_text(encoding="utf-8"))
    found = [TITLE.search((PACKAGE / "web" / name).read_text(encoding="utf-8")).groups()
             for name in names]
    return [(english or both, chinese or both) for english, chinese, both in found]


@pytest.mark.parametrize(("readme", "language"), [("README.md", 0), ("README.zh-CN.md", 1)])
def test_the_readme_lists_the_tabs_by_the_names_that_the_page_shows(readme, language):
    text = (PACKAGE / readme).read_text(encoding="utf-8")
    table = re.search(r"^\| (?:tab|标签页) \|.*\n\|[-|]+\n((?:\|.*\n)+)", text, re.MULTILINE)[1]
    cells = [row.split("|")[1].strip() for row in table.splitlines()]
    listed = [re.sub(r"\[(.*)\]\(.*\)", r"\1", name) for cell in cells
              for name in re.split(", |、", cell)]
    assert listed == [title[language] for title in titles()]


def test_messages_name_the_tabs_as_the_page_does():
    for english, chinese in titles():
        line = f"rqt has no window here; the page in the browser does its work, tab {english}. "
        assert f"“{chinese}”标签页" in read_catalogue("zh_CN").translate(line + "Type: make")


@pytest.fixture
def refusing(monkeypatch):
    """Two things to watch: one that fails, and one that tells lines."""
    class Failing(Paced):
        def collect(self):
            raise Refused("/a: no such topic. The Topics tab lists what there is")

    class Telling(Paced):
        def collect(self):
            return self.changed({"faults": ["/finder sends /line, which nobody hears"],
                                 "loose": ["a learner's own words"]})

    monkeypatch.setitem(registry._watchables, "failing", Failing)
    monkeypatch.setitem(registry._watchables, "telling", Telling)


@pytest.mark.parametrize(("language", "error", "refusal", "line"), [
    ("", "/a: no such topic.", "there is no operation 'none'", "/finder sends /line"),
    ("zh_CN", "/a：没有这个话题", "没有操作 'none'", "/finder 发送 /line"),
    ("xx", "/a: no such topic.", "there is no operation 'none'", "/finder sends /line")])
def test_refusals_errors_and_lines_are_in_the_pages_language(
        visit, refusing, language, error, refusal, line):
    async def story(http, port):
        link = await http.ws_connect(f"/ws?language={language}")
        heard = {}
        for what in ("failing", "telling"):
            await link.send_json({"id": what, "op": "watch", "what": what})
        await link.send_json({"id": "refused", "op": "none"})
        while len(heard) < 3:
            message = await link.receive_json()
            if message.get("ok") is False:
                heard["refusal"] = message["error"]
            if "watch" in message:
                heard["error" if "error" in message["data"] else "told"] = message["data"]
        return heard

    heard = visit(story)
    assert heard["refusal"].startswith(refusal)
    assert heard["error"]["error"].startswith(error)
    assert heard["told"]["faults"][0].startswith(line)
    assert heard["told"]["loose"] == ["a learner's own words"]
