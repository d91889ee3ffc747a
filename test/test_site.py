"""`make site`: every link leads somewhere, no other host is asked, and both languages are whole."""

import ast
import fcntl
import html
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

pytestmark = pytest.mark.processes

ROOT = Path(__file__).resolve().parent.parent
TOOL = ROOT / "tools/site"
sys.path.append(str(TOOL))

from advice import _line, advice, cut, helps  # noqa: E402
from checking import faults  # noqa: E402
from rclpy_text import RULES, Program  # noqa: E402
from recording import bench, watched_controller  # noqa: E402
from ros2 import PLACES, lessons, packages, twins  # noqa: E402
from staging import Pages, _with_links, menu, repository_pages  # noqa: E402

from bullet_sim.errors import PluginError  # noqa: E402
from bullet_sim_ros.interface import documented  # noqa: E402

OWN = "<!doctype html><p id='run'>a replay</p>"


def built(folder: Path, *words: str) -> subprocess.CompletedProcess:
    """Runs the builder with a small replay."""
    replay = folder / "run.html"
    replay.write_text(OWN, "utf-8")
    return subprocess.run(
        [sys.executable, TOOL, "--out", folder / "site", "--replay", replay, *words],
        capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site of this repository."""
    folder = tmp_path_factory.mktemp("site")
    done = built(folder)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert "pages in" in done.stdout
    assert sorted(path.name for path in folder.iterdir()) == [".site.lock", "run.html", "site"]
    return folder / "site"


def test_both_languages_have_the_same_pages_and_a_replay(site):
    pages = {language: {path.relative_to(site / language)
                        for path in (site / language).rglob("*.html")}
             for language in ("en", "zh")}
    assert pages["en"] == pages["zh"] and len(pages["en"]) > 90
    assert (site / "demo/run.html").read_text("utf-8") == OWN
    for language in pages:
        page = (site / language / "demo.html").read_text("utf-8")
        assert f'src="../demo/run.html?{language}"' in page


def test_the_notebook_is_a_page_in_each_language(site):
    pages = {language: (site / language / "docs/first-drive.html").read_text("utf-8")
             for language in ("en", "zh")}
    for language, own, other in (("en", "Ten steps of 1 ms", "每走十步"),
                                 ("zh", "每走十步", "Ten steps of 1 ms")):
        assert own in pages[language] and other not in pages[language]
        assert "load_course" in pages[language] and "make wheels" in pages[language]
    assert 'id="the-robot">The robot<' in pages["en"] and ">机器人<" in pages["zh"]


def test_every_link_and_anchor_of_the_built_pages_leads_somewhere(site):
    assert faults(site) == []


def test_no_page_style_or_script_asks_another_host(site):
    for path in [*site.rglob("*.html"), *site.rglob("*.css")]:
        text = path.read_text("utf-8")
        assert not re.search(r"""url\(["']?(https?:)?//|@import""", text), path
        assert "fonts.g" not in text and "unpkg" not in text, path


def test_the_search_has_each_language_and_splits_chinese_into_words(site):
    docs = {language: json.loads((site / language / "search/search_index.json").read_text("utf-8"))
            for language in ("en", "zh")}
    words = {word for each in docs["zh"]["docs"] for word in each["text"].split("\u200b")}
    assert {"雷达", "里程计", "课程"} <= words
    assert any("odometry" in each["text"] for each in docs["en"]["docs"])
    for language in docs:
        (script,) = (site / language / "assets/javascripts/workers").glob("search.*.js")
        assert "o<=t.length;o++)t.slice(s,o)in e" in script.read_text("utf-8")


def page(site: Path, path: str) -> str:
    """A built page's text without its tags."""
    return html.unescape(re.sub(r"<[^>]+>", "", (site / path).read_text("utf-8")))


def test_every_plugin_and_controller_has_a_page_with_an_example_that_was_loaded(site):
    rows = {name: row for name, row in documented().items()
            if name.endswith(".so") and row.status != "absent"}
    types = {tag.name for tag in documented()["controllers"].tags.values()
             if tag.status != "absent"}
    assert len(rows) > 50 and len(types) > 20
    for name in rows:
        for language in ("en", "zh"):
            text = page(site, f"{language}/reference/plugins/{Path(name).stem}.html")
            assert re.search(rf'<plugin name="p" filename="{re.escape(name)}"', text), name
            assert all(tag in text for tag in rows[name].tags), name
    for name in types:
        file = re.sub(r"\W", "_", name)
        assert f"type: {name}" in page(site, f"en/reference/controllers/{file}.html")


@pytest.mark.parametrize("path, row", [
    ("plugins/libgazebo_ros_diff_drive", "tag default unit note robotNamespace"),
    ("plugins/libgazebo_ros_diff_drive", "wheelSeparation 0.34 m"),
    ("plugins/libgazebo_ros_diff_drive", "robotNamespace the model's name"),
    ("plugins/libgazebo_ros_diff_drive", "subscribes to /bot/cmd_vel geometry_msgs/Twist"),
    ("plugins/libgazebo_ros_tricycle_drive", "wheelAcceleration 0 rad/s²"),
    ("plugins/libgazebo_ros_imu", "bodyName required"),
    ("plugins/libgazebo_ros_imu", "frameName the link's name"),
    ("plugins/libgazebo_ros_kobuki", "wheel_diameter required m"),
    ("plugins/libgazebo_ros_planar_move", "robotBaseFrame base_footprint"),
    ("plugins/libgazebo_ros_velodyne_laser", "max_range no limit m"),
    ("controllers/diff_drive_controller_DiffDriveController", "cmd_vel_timeout 0.5 s"),
    ("controllers/effort_controllers_JointPositionController", "pid/p required"),
    ("controllers/position_controllers_JointTrajectoryController",
     "subscribes to /r/my_controller/command trajectory_msgs/JointTrajectory"),
])
def test_defaults_units_and_topics_are_those_of_the_code(site, path, row):
    assert row in " ".join(page(site, f"en/reference/{path}.html").split())


def test_the_page_of_errors_has_each_line_of_ours_that_says_what_to_type(site):
    english, chinese = (page(site, f"{language}/reference/advice.html")
                        for language in ("en", "zh"))
    assert len(advice()) > 200
    for says, do, translated in advice().values():
        assert _line(says).strip(" `") in english, says
        assert _line(do).strip(" `") in english, do
        assert _line(translated).strip(" `") in chinese, translated
    for said in ("port … is root's", "Unable to communicate with master"):
        assert said in english
    sections = yaml.safe_load((TOOL / "advice.yaml").read_text("utf-8"))
    common = [each for section in sections for each in section.get("common", ())]
    assert len(common) >= 20 and all(each["en"] and each["zh"] for each in common)
    own, other = (english.rindex(title) for title in (
        "The line follower and its simulator", "Trials and marking"))
    assert own < english.rindex("A simulator runs already on this master") < other


@pytest.mark.parametrize("line, says, do", [
    ("{0} is full; make room there, then type this again", "{0} is full",
     "make room there, then type this again"),
    ("{0} has no name: give it one", "{0} has no name", "give it one"),
    ("Nobody listens to {0} yet. If {1} is meant, end this program and start it with {2}:={3}.",
     "Nobody listens to {0} yet", "If {1} is meant, end this program and start it with {2}:={3}."),
    ("{0} hides it. In a terminal for the courses' type: source {1}", "{0} hides it",
     "In a terminal for the courses' type: source {1}"),
])
def test_a_line_is_cut_where_its_sentence_ends(line, says, do):
    assert cut(line) == (says, do)


@pytest.mark.parametrize("line", [
    'sys.exit("it waits; give each message its time instead")',
    "1: pause, 0: go on", "{0}; export the file again", "{0}: {1}: give another --out",
    "; type export {0}=VALUE", "(on the machine where it runs; then start it again)",
    "Load and start controllers, stop and unload them when this ends.",
    "{0} has to be an entry with name, type and params",
    "{0} has to be an entry with name: type and params", "{0} must be exercises, NAME: {{1}}",
    "model {0}: sensor {1}: type {2} is not simulated", "To see it, type: source devel/setup.bash"])
def test_a_line_that_is_no_advice_is_left_out(line):
    assert cut(line) is None


def test_what_only_help_shows_is_no_advice():
    found = {(says, do) for says, do, _ in advice().values()}
    assert not any(says in ("", "list") or do == "go on" for says, do in found)
    program = ROOT / "src/compat/gazebo_ros/src/gazebo_ros/gz.py"
    assert "1: pause, 0: go on" in helps(program) and helps(ROOT / "scripts/help.sh") == set()
    shown = {f"{says}{between}{do}" for says, do in found for between in ("; ", ". ", ": ")}
    assert not shown & set().union(*(helps(ROOT / place.split(": ")[0]) for place in advice()))


def test_each_lesson_has_a_text_for_ros_2_or_a_line_that_takes_its_place(site):
    shown, instead = twins(), RULES["instead"]
    assert len(lessons()) > 85 and lessons().keys() <= shown.keys() | instead.keys()
    assert RULES["files"].keys() <= lessons().keys()
    assert packages() == {name.partition("/")[0] for name in shown.keys() | instead.keys()}
    for language in ("en", "zh"):
        pages = {name: page(site, f"{language}/docs/ros2/{name}.html") for name in packages()}
        for name, text in shown.items():
            package, _, file = name.partition("/")
            assert file in pages[package]
            assert all(line.strip() in pages[package] for line in (text or "").splitlines()), name
        for name, text in instead.items():
            assert re.sub("[`*]", "", text[language]) in pages[name.partition("/")[0]], name


def test_each_text_written_by_hand_is_of_its_lesson_as_it_is_today():
    sums = TOOL / "twins/lessons.sha256"
    listed = sums.read_text("utf-8").split()[1::2]
    named = [f"{PLACES.match(path)['package']}/{Path(path).name}" for path in listed]
    assert sorted(name.replace(".launch", ".launch.py") for name in named) == sorted(
        str(path.relative_to(TOOL / "twins")) for path in TOOL.glob("twins/*/*"))
    done = subprocess.run(["sha256sum", "--check", "--quiet", sums], cwd=ROOT, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    assert done.returncode == 0, (
        f"{done.stdout}: bring their texts below tools/site/twins up to these lessons, then type: "
        f"sha256sum $(cut -c67- {sums}) > new; mv new {sums}")


def test_each_text_for_ros_2_is_python_that_only_speaks_rclpy(tmp_path):
    texts = {name: text for name, text in twins().items() if text}
    for name, text in texts.items():
        compile(text, name, "exec")
        names = {getattr(node, "module", None) or each.name for node in ast.walk(ast.parse(text))
                 if isinstance(node, ast.Import | ast.ImportFrom) for each in node.names}
        assert not {each.split(".")[0] for each in names} & {
            "rospy", "rosbag", "actionlib", "roslib", "rosgraph", "rospkg"}, name
        own = tmp_path / f"{name.replace('/', '.')}.py"
        own.write_text(text, "utf-8")
    done = subprocess.run(  # no name is undefined, none is imported in vain
        [sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache", "-q", "--select", "F",
         "--ignore", "F841", tmp_path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("source, text", [
    ('rospy.loginfo("%s is %d", a, b)', 'node.get_logger().info("%s is %d" % (a, b))'),
    ('rospy.logwarn_throttle(2, "lost")',
     'node.get_logger().warning("lost", throttle_duration_sec=2)'),
    ('p = rospy.Publisher("~a", String, queue_size=1, latch=True)\np.publish("x")',
     'p = node.create_publisher(\n    String, "~/a", QoSProfile(depth=1, '
     'durability=DurabilityPolicy.TRANSIENT_LOCAL))\np.publish(String(data="x"))'),
    ('rospy.Subscriber("a", Image, f, queue_size=1)',
     'node.create_subscription(Image, "a", f, qos_profile_sensor_data)'),
    ("while not rospy.is_shutdown():\n    rospy.sleep(0.1)",
     "while rclpy.ok():\n    node.get_clock().sleep_for(Duration(seconds=0.1))"),
    ('x = rospy.get_param("~x", 1.0)', 'x = node.declare_parameter("x", 1.0).value'),
    ("m.header.stamp = rospy.Time.now()", "m.header.stamp = node.get_clock().now().to_msg()"),
    ("ColorRGBA(1, 0, 0, 1)", "ColorRGBA(r=1.0, g=0.0, b=0.0, a=1.0)"),
])
def test_a_call_of_rospy_becomes_one_of_rclpy(source, text):
    head = "import rospy\nfrom std_msgs.msg import ColorRGBA, String\n"
    assert Program(f"{head}{source}\n").text().endswith(
        f"from std_msgs.msg import ColorRGBA, String\n{text}\n")


def test_a_lesson_that_speaks_to_ros_in_a_new_way_is_named():
    with pytest.raises(ValueError, match=r"no rule for: x = rospy\.new_thing"):
        Program("import rospy\nx = rospy.new_thing\n").text()


def test_an_example_that_does_not_load_is_an_error_with_its_reason():
    with bench() as made, pytest.raises(PluginError, match=r"Controller: .*no joint.*'gone'"):
        watched_controller("velocity_controllers/JointVelocityController",
                           {"arm": {"joint": "gone"}}, made)


@pytest.mark.parametrize("text, linked", [
    ("[a](docs/linux.md)", "[a](docs/linux.md)"),
    ("[a](docs/linux.zh-CN.md#x)", "[a](docs/linux.md#x)"),
    ("[lessons](src/lessons)", "[lessons](src/lessons/README.md)"),
    ("[licence](LICENSE)", "licence (`LICENSE`)"),
    ("[packages.yaml](dependencies/packages.yaml)", "`dependencies/packages.yaml`"),
    ("[`x`](https://example.org/a)", "[`x`](https://example.org/a)"),
    ("`[a](LICENSE)`", "`[a](LICENSE)`"),
    ("一行，\n又一行\n\n另一段", "一行，又一行\n\n另一段"),
    ("| `a\\|b` | c\\|d |", "| `a|b` | c\\|d |"),
    ("```\n[a](LICENSE)\n```", "```\n[a](LICENSE)\n```"),
])
def test_links_lead_to_pages_and_files_are_their_paths(text, linked):
    texts = dict.fromkeys(("README.md", "docs/linux.md", "src/lessons/README.md"), "# T\n")
    assert _with_links(text, "README.md", Pages({"en": texts, "zh": texts}), "en") == linked


def test_an_english_text_among_the_chinese_names_the_chinese_anchor():
    pages = Pages({"en": {"a.md": "# A\n## Where\n"}, "zh": {"a.md": "# 甲\n## 哪里\n"}})
    assert _with_links("[w](a.md#where)", "b.md", pages, "zh") == "[w](a.md#哪里)"


def test_each_page_is_in_the_menu_once_and_a_new_place_is_named():
    pages = repository_pages()
    chosen = [path for section in menu(pages.texts["en"], "en") for entries in section.values()
              for entry in entries for path in entry.values()]
    assert sorted(chosen) == sorted(pages.texts["en"])
    with pytest.raises(ValueError, match=r"sections\.yaml: no section has elsewhere/a\.md"):
        menu({"elsewhere/a.md": "# A"}, "en")


@pytest.mark.parametrize("body, problem", [
    ('<a href="gone.html">', "gone.html: there is no such file"),
    ('<a href="#gone">', "#gone: the page has no such anchor"),
    ('<a href="../../b.html">', "no such file"),
    ('<a href=".">', ".: leads to a folder"),
    ('<a href="/b.html">', "begins at the server's root"),
    ('<img src="https://example.org/a.png">', "is loaded from another host"),
    ('<script src="//example.org/a.js">', "is loaded from another host"),
])
def test_a_dead_or_foreign_link_is_a_line_with_its_page(tmp_path, body, problem):
    (tmp_path / "a.html").write_text(f'<p id="here">{body}<a href="#here"><a href="https://x.org">')
    (found,) = faults(tmp_path)
    assert found.startswith("a.html: ") and problem in found


def old_site(folder: Path) -> Path:
    """A site's folder; returns its first page, which has the text "old"."""
    for name in ("en", "zh", "demo"):
        (folder / name).mkdir(parents=True)
    (folder / "index.html").write_text("old")
    return folder / "index.html"


def test_a_replay_that_is_not_there_is_one_line_and_the_old_site_stays(tmp_path):
    old = old_site(tmp_path / "site")
    (tmp_path / "site.x.unfinished").mkdir()  # of a build that was killed
    done = built(tmp_path, "--replay", str(tmp_path / "none.html"))
    assert (done.returncode, done.stderr) == (
        1, f"site: {tmp_path}/none.html: No such file or directory\n")
    assert old.read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == [".site.lock", "run.html", "site"]


def test_a_folder_that_is_no_site_is_refused_and_stays_as_it_was(tmp_path):
    for name in ("letter.txt", "index.html", "en/a.md"):
        own = tmp_path / "site" / name
        own.parent.mkdir(parents=True, exist_ok=True)
        own.write_text("mine")
        done = built(tmp_path)
        assert (done.returncode, done.stderr) == (
            1, f"site: {tmp_path}/site is there and is no site that was built before: name another"
               " folder with --out\n")
        assert own.read_text() == "mine"


def test_a_second_build_ends_with_one_line_and_leaves_the_first_one_alone(tmp_path):
    old = old_site(tmp_path / "site")
    running = tmp_path / "site.x.unfinished/site"
    running.mkdir(parents=True)
    with (tmp_path / ".site.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        done = built(tmp_path)
    assert (done.returncode, done.stderr) == (
        1, f"site: {tmp_path}/site is being built by another make site: wait until it ends, then"
           " type this again\n")
    assert running.is_dir() and old.read_text() == "old"


def test_what_is_left_beside_another_name_stays(tmp_path):
    (tmp_path / "site1.x.unfinished").mkdir()
    built(tmp_path, "--out", str(tmp_path / "site[1]"), "--replay", str(tmp_path / "none.html"))
    assert (tmp_path / "site1.x.unfinished").is_dir()
