"""The site below /lessons/: its own files and no other, and what to type before it is built."""

import pytest
from sim_viewer import lessons
from yarl import URL


@pytest.fixture
def site(tmp_path, monkeypatch):
    """A folder in place of out/site, beside a file that is nobody's business."""
    (tmp_path / "secret.html").write_text("secret")
    monkeypatch.setattr(lessons, "site_folder", lambda: tmp_path / "site")
    return tmp_path / "site"


def build(site) -> None:
    (site / "en").mkdir(parents=True)
    (site / "index.html").write_text("start")
    (site / "en/page.html").write_text("a page")
    (site / "en/out.html").symlink_to(site.parent / "secret.html")


def test_before_it_is_built_the_link_says_what_to_type(site, visit):
    async def story(http, port):
        async with http.get("/lessons/zh/index.html") as answer:
            assert (answer.status, answer.content_type) == (404, "text/plain")
            assert "type: make site" in await answer.text()
    visit(story)


def test_its_files_are_served_with_a_policy_that_asks_no_other_host(site, visit):
    build(site)

    async def story(http, port):
        for path, text in (("/lessons/", "start"), ("/lessons/en/page.html", "a page")):
            async with http.get(path) as answer:
                assert (answer.status, await answer.text()) == (200, text)
                policy = answer.headers.getall("Content-Security-Policy")
                assert len(policy) == 1 and "'unsafe-inline'" in policy[0]
                assert "http" not in policy[0] and "*" not in policy[0]
                assert answer.headers["X-Content-Type-Options"] == "nosniff"
        async with http.get("/") as answer:  # the page itself stays as strict as it was
            assert "script-src" not in answer.headers["Content-Security-Policy"]
            assert answer.headers["Content-Security-Policy"].startswith("default-src 'self'; ")
            assert 'id="lessons"' in await answer.text()
    visit(story)


def test_the_site_is_looked_for_only_where_make_can_build_it(tmp_path, monkeypatch):
    folder = tmp_path / "one/share/sim_viewer"
    monkeypatch.setattr(lessons.rospkg.RosPack, "get_path", lambda self, name: str(folder))
    look = lessons.site_folder.__wrapped__
    assert look() is None
    (tmp_path / "Makefile").touch()
    assert look() == tmp_path / "out/site"


def test_an_installation_without_the_repository_does_not_ask_to_type_make_there(
        monkeypatch, visit):
    monkeypatch.setattr(lessons, "site_folder", lambda: None)

    async def story(http, port):
        async with http.get("/lessons/en/index.html") as answer:
            assert answer.status == 404
            assert "in a clone of the courses" in await answer.text()
    visit(story)


def test_the_address_without_its_slash_leads_to_the_site(site, visit):
    build(site)

    async def story(http, port):
        async with http.get("/lessons?token=secret") as answer:
            assert (answer.status, await answer.text()) == (200, "start")
            assert answer.url.path == "/lessons/"
    visit(story, token="secret")


@pytest.mark.parametrize("path", [
    "/lessons/../secret.html", "/lessons/%2e%2e/secret.html", "/lessons/..%2fsecret.html",
    "/lessons/en/out.html", "/lessons//etc/passwd", "/lessons/%2fetc%2fpasswd", "/lessons/en",
    "/lessons/en/gone.html", "/lessons/%00"])
def test_nothing_outside_of_the_site_is_served(site, visit, path):
    build(site)

    async def story(http, port):
        async with http.get(URL(path, encoded=True)) as answer:
            assert answer.status == 404
            assert "secret" not in await answer.text()
    visit(story)


def test_it_needs_the_token_as_the_page_does(site, visit):
    build(site)

    async def story(http, port):
        async with http.get("/lessons/en/page.html") as answer:
            assert answer.status == 403
        async with http.get("/lessons/en/page.html?token=secret") as answer:
            assert answer.status == 200
    visit(story, token="secret")
