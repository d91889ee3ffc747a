"""Every command that README.md and the pages of docs/ show is run by something.

readme_commands.yaml beside this says what runs it.
"""

import os
import re
import shlex
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
MOST_LINES = 150
# Both languages of a page show the same commands.
PAGES = ("README.md", *(f"docs/{name}.md" for name in (
    "racecar", "navigation", "marking", "workers", "benchmarks")))
RUNNERS = yaml.safe_load(
    (Path(__file__).parent / "readme_commands.yaml").read_text(encoding="utf-8")
)
FENCE = re.compile(r"^```(bash|console|sh|shell)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`((?:make|source|docker|sudo|git|ros[a-z]+) [^`<>…]+)`")
BUILT = (ROOT / "devel" / "setup.bash").exists()


def commands_in(text: str) -> list[str]:
    """Those between backquotes in sentences and tables, then those of the shell fences.

    In a console fence what follows `$ ` is a command, in the others all but comments.
    """
    commands = [" ".join(found.split()) for found in INLINE.findall(FENCE.sub("", text))]
    for language, body in FENCE.findall(text):
        for line in body.replace("\\\n", " ").splitlines():
            if language == "console":
                line = line[2:] if line.startswith("$ ") else ""
            line = " ".join(re.sub(r"(^|\s)#.*", "", line).split())
            if line:
                commands.append(line)
    return commands


def commands_of(name: str) -> list[str]:
    path = ROOT / name
    return commands_in(path.read_text(encoding="utf-8")) if path.exists() else []


COMMANDS = sorted({command for page in PAGES for command in commands_of(page)})


def translated(page: str) -> str:
    return page.replace(".md", ".zh-CN.md")


def runner_of(command: str) -> dict | None:
    return next((r for r in RUNNERS if re.fullmatch(r["match"], command)), None)


@cache
def sourced() -> dict[str, str]:
    """The environment of a person who has sourced the workspace, where there is a built one."""
    enter = "source devel/setup.bash; " if BUILT else ""
    said = subprocess.run(["bash", "-c", f"{enter}env -0"], cwd=ROOT, text=True, check=True,
                          stdout=subprocess.PIPE).stdout
    return dict(each.split("=", 1) for each in said.split("\0") if each)


def in_workspace(command: str, limit: float = 30.0) -> subprocess.CompletedProcess:
    """Runs it as such a person would."""
    return subprocess.run(["bash", "-c", command], cwd=ROOT, timeout=limit, text=True,
                          env=sourced(), capture_output=True, stdin=subprocess.DEVNULL)


def not_there(command: str) -> str | None:
    """What a make, rosrun or roslaunch line names and the workspace does not have."""
    words = shlex.split(command)
    if words[0] == "make":
        return in_workspace(f"env -u MAKELEVEL -u MAKEFLAGS make -n {command[5:]}").stderr or None
    if words[0] == "roslaunch" and len(words) > 2:
        return launch_error(words[1:]) if BUILT else None
    if words[0] == "rosrun" and len(words) > 2 and BUILT:
        package, executable = shlex.quote(words[1]), shlex.quote(words[2])
        found = in_workspace(
            f"find -L $(catkin_find --libexec --share {package} 2>/dev/null;"
            f" rospack find {package}) -name {executable} -type f -perm /111 | head -1")
        return None if found.stdout.strip() else f"{words[1]} has no executable {words[2]}"
    return None


def launch_error(words: list[str]) -> str | None:
    """roslaunch resolves the file with all it includes, its arguments and its nodes' names."""
    quoted = " ".join(shlex.quote(word) for word in words)
    done = in_workspace(f"roslaunch --nodes {quoted}")
    return None if done.returncode == 0 else done.stderr.strip() or done.stdout.strip()


def test_readme_shows_commands() -> None:
    assert (ROOT / "README.md").exists(), "there is no README.md"
    assert any(c.startswith("make course") for c in COMMANDS), "README.md never says `make course`"
    assert "make test" in COMMANDS, "README.md never says `make test`"


@pytest.mark.parametrize("page", PAGES)
def test_the_chinese_page_shows_the_same(page: str) -> None:
    assert (ROOT / translated(page)).exists(), f"there is no {translated(page)}"
    assert commands_of(translated(page)) == commands_of(page)


@pytest.mark.parametrize(("name", "words"), [
    ("README.md", "skip its `apt-get install ros-noetic-"),
    ("README.zh-CN.md", "跳过教程里的 `apt-get install ros-noetic-")])
def test_the_readme_says_what_of_a_tutorial_is_not_typed(name: str, words: str) -> None:
    assert words in (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ("README.md", "README.zh-CN.md"))
def test_the_readme_is_short(name: str) -> None:
    assert len((ROOT / name).read_text(encoding="utf-8").splitlines()) <= MOST_LINES


@pytest.mark.parametrize("page", sorted(
    str(path.relative_to(ROOT)) for path in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"))))
def test_links_lead_to_files(page: str) -> None:
    text = FENCE.sub("", (ROOT / page).read_text(encoding="utf-8"))
    targets = [link.partition("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", text)
               if not re.match(r"https?:", link)]
    assert not [link for link in targets if not (ROOT / page).parent.joinpath(link).exists()]


@pytest.mark.parametrize("page", ("docs/security.md", "docs/security.zh-CN.md"))
def test_the_tests_that_a_page_names_are_there(page: str) -> None:
    named = re.findall(r"`(\w+\.(?:py|test))`(?:(?:: |：)`(test_\w+)`)?",
                       (ROOT / page).read_text(encoding="utf-8"))
    files = [*ROOT.glob("test/*.py"), *ROOT.glob("src/**/test/**/*.*")]
    texts = {file: "".join(path.read_text(encoding="utf-8") for path in files if path.name == file)
             for file in {file for file, _ in named}}
    assert len(named) > 40 and all(texts.values())
    assert not [each for each in named if each[1] not in texts[each[0]]]


def test_every_page_is_in_the_index() -> None:
    for suffix in ("", ".zh-CN"):
        index = (ROOT / f"docs/README{suffix}.md").read_text(encoding="utf-8")
        for page in ROOT.glob("docs/*.md"):
            if page.name.endswith(".zh-CN.md") == bool(suffix) and page.stem != f"README{suffix}":
                assert f"({page.name})" in index, page.name


@pytest.mark.parametrize("command", COMMANDS)
def test_something_runs(command: str) -> None:
    runner = runner_of(command)
    assert runner, f"nothing runs `{command}`: give it a line in test/readme_commands.yaml"
    missing = not_there(command)
    assert not missing, f"`{command}`: {missing}"
    if runner.get("here"):
        done = in_workspace(command)
        assert done.returncode == 0, done.stdout + done.stderr
    else:
        by = ROOT / runner["by"]
        assert by.is_file() or any(by.glob("*test*")), f"{runner['by']}, which runs it, is missing"


def test_docker_services_exist() -> None:
    services = yaml.safe_load((ROOT / "docker" / "compose.yaml").read_text())["services"]
    for command in COMMANDS:
        if re.match(r"docker compose .*\b(run|up)\b", command):
            assert command.split()[-1] in services, command


@pytest.mark.parametrize(("words", "unknown"), [
    ("course SEEDS=3 LAPS=2", "SEEDS="), ("autorace SEDS=3 MISION=bar", "SEDS= MISION="),
    ("course WORKERS=2", "WORKERS="), ("autorace WORKERS=2 MISSION=bar", ""), ("course", "")])
def test_make_refuses_what_the_verb_does_not_take(words: str, unknown: str) -> None:
    by_hand = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    done = subprocess.run(["make", "-n", *words.split()], cwd=ROOT, env=by_hand, text=True,
                          capture_output=True, check=False)
    assert done.returncode == (2 if unknown else 0), done.stderr
    assert len(done.stderr.splitlines()) == bool(unknown)
    assert not unknown or f"has no option {unknown}; " in done.stderr


def test_clean_forgets_what_was_made(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "scripts", tmp_path / "scripts")
    shutil.copy(ROOT / "Makefile", tmp_path)
    for made in (".venv", "build", "devel", ".setup", "src", "test", "tools", "out/course"):
        (tmp_path / made).mkdir(parents=True)
    subprocess.run(["make", "clean"], cwd=tmp_path, check=True, capture_output=True)
    left = {path.name for path in tmp_path.iterdir()}
    assert left == {"Makefile", "out", "scripts", "src", "test", "tools"}


def test_commands_are_found() -> None:
    shell = "```bash\nmake a  # b\n# c\nd \\\n  e\n```\n"
    text = shell + "\n```console\n$ f\nanswer\n```\n```python\ng\n```\n"
    assert commands_in(text + "type `make b` or `this`") == ["make b", "make a", "d e", "f"]
