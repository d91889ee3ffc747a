"""Every text of the terminal exists in Chinese, with the same values, and compiled."""

import gettext
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
# What a terminal begins with, and what ~/.bashrc has for it, also in another Linux's Debian.
TYPED = BASHRC = f"source {ROOT}/devel/setup.bash"
if Path("/etc/ros1-driving-courses").exists():
    TYPED = f"make -sC {ROOT} shell"
    BASHRC = f"alias courses='{TYPED}'"
sys.path.insert(0, str(ROOT / "scripts"))
import terminal_texts  # noqa: E402

VALUE = {"courses": r"\{\d+\}",
         "courses-shell": r"\$\{\w+|\$\w+|\$\([^)]*\)|%s|`[^`]*`|\[(?!OPTION)[A-Z_]+="}


def catalogue(path: Path) -> dict[str, str]:
    """A .mo file's texts and translations."""
    with path.open("rb") as file:
        found = gettext.GNUTranslations(file)._catalog
    return {english: text for english, text in found.items() if english}


def shipped(domain: str) -> dict[str, str]:
    folder = terminal_texts.LOCALES / terminal_texts.LANGUAGE / "LC_MESSAGES"
    return catalogue(folder / f"{domain}.mo")


@pytest.mark.parametrize("domain", terminal_texts.DOMAINS)
def test_every_text_has_a_chinese_translation(domain: str) -> None:
    texts = terminal_texts.DOMAINS[domain]()
    missing = [f"{files[0]}: {text}" for text, files in texts.items()
               if not shipped(domain).get(text)]
    assert not missing, ("python3 scripts/terminal_texts.py adds these to the .po file, "
                         "where each needs its Chinese:\n" + "\n".join(missing))


@pytest.mark.parametrize("domain", terminal_texts.DOMAINS)
def test_a_translation_has_the_same_values(domain: str) -> None:
    wrong = [f"{english}\n  {chinese}" for english, chinese in shipped(domain).items()
             if set(re.findall(VALUE[domain], english)) != set(re.findall(VALUE[domain], chinese))]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("domain", terminal_texts.DOMAINS)
def test_the_compiled_catalogue_is_that_of_the_po_file(domain: str, tmp_path: Path) -> None:
    terminal_texts.compile_catalogue(domain, tmp_path)
    assert catalogue(tmp_path / f"{domain}.mo") == shipped(domain), \
        "python3 scripts/terminal_texts.py --compile"


def test_what_is_a_text_of_a_program() -> None:
    source = '''"""No docstring of it."""
def f(a):
    """Nor this one here."""
    print("one line %s and\\nanother line {a} of it" % a)
    raise ValueError(f"{a:.2f} is not {'the wrong value here' if a else 1}, 50 % off")
    return "share/of/a/path", "<!-- a b c d", "two words", "the first words: " + ", ".join(a)
'''
    assert set(terminal_texts.texts_of(source)) == {
        "one line {0} and", "another line {1} of it", "{0} is not {1}, 50 % off",
        "the wrong value here", "the first words: {0}"}


@pytest.mark.parametrize("shown, texts", [
    ("argparse.ArgumentParser(description=__doc__)", {"What it does, in two lines."}),
    ("argparse.ArgumentParser(description=own)", set()),
    ("progress.say('files: %s' % x)", {"files: {0}"}),
    ("progress.status(f'waiting for {x}')", {"waiting for {0}"}),
    ("f'at {x} s | lap {y} | off line {z}'", {"at {0} s | lap {1} | off line {2}"}),
    ("Finding(where, 'it says', status)", {"it says"}),
    ("'one or|two and some'", set())])
def test_texts_of_descriptions_and_progress_lines(shown: str, texts: set[str]) -> None:
    source = f'"""What it does,\nin two lines.\n"""\n{shown}\n'
    assert set(terminal_texts.texts_of(source)) == texts


@pytest.mark.parametrize("text", ["A page runs already: {0}", "the scene cannot be shown: {0}"])
def test_the_page_s_server_prints_texts(text: str) -> None:
    assert text in terminal_texts.python_texts()


def said(command: list[str], **environment: str) -> str:
    base = {name: value for name, value in os.environ.items() if name not in (
        "LANG", "LANGUAGE", "LC_ALL", "LC_MESSAGES", "MAKELEVEL", "MAKEFLAGS", "MFLAGS")}
    done = subprocess.run(command, cwd=ROOT, env=base | environment, text=True, encoding="utf-8",
                          capture_output=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.parametrize(("environment", "word"), [
    ({"LANG": "zh_CN.UTF-8"}, "没有选项"), ({"LC_ALL": "zh_CN.UTF-8"}, "没有选项"),
    ({"LC_ALL": "C.UTF-8", "LANGUAGE": "zh_CN"}, "没有选项"), ({"LANGUAGE": "zh"}, "没有选项"),
    ({"LANG": "zh_CN.UTF-8", "LC_ALL": "C"}, "unknown option"), ({}, "unknown option"),
    ({"LANG": "en_US.UTF-8"}, "unknown option"),
    ({"LANG": "zh_CN.UTF-8", "LANGUAGE": "en"}, "unknown option")])
def test_the_scripts_follow_the_locale(environment: dict[str, str], word: str) -> None:
    last = said(["scripts/setup.sh", "--x"], **environment).splitlines()[-1]
    assert last.startswith(f"setup: {word}")


@pytest.mark.parametrize(("words", "english", "chinese"), [
    ("corse", "make has no command corse; is course meant?", "是不是想输入 course？"),
    ("go", "make go is a command of the lesson src/lessons/lane_keeping; type: make -C "
           "src/lessons/lane_keeping go", "请输入：make -C src/lessons/lane_keeping go"),
    ("course LAP=2", "make course has no option LAP=; is LAPS meant?", "是不是想输入 LAPS？"),
    ("course FAST=maybe", "FAST=maybe: write 1 or 0, or leave it out", "FAST=maybe：请写 1 或 0"),
    ("lane FAST=' PEOPLE=`", "FAST=' PEOPLE=`: write 1 or 0, or leave it out", "请写 1 或 0"),
    ("course SEED=\"x", 'SEED="x: write a whole number, or leave it out', "请写整数"),
    ("navigate PACE=x", "PACE=x: write a number, such as 2 or 0.5", "请写数字"),
    ("navigate PACE=-1", "PACE=-1: write a number above 0, or leave it out", "请写大于 0 的数"),
    ("course LAPS=-1", "LAPS=-1: write a number above 0, or leave it out", "请写大于 0 的数"),
    ("course SEED=-1", "SEED=-1: write a whole number, or leave it out", "请写整数"),
    ("-C src/lessons/lane_keeping strat", "make has no command strat; is start meant?",
     "是不是想输入 start？"),
    ("-C src/lessons/lane_keeping go SPEED=fast", "make go has no option SPEED=; `make` alone",
     "make go 没有选项 SPEED="),
    ("-C src/lessons/lane_keeping bridge", "No bridge is needed: the simulator's topics",
     "不需要桥接：仿真器的话题"),
    ("course LAPS=0", "LAPS=0: write a number above 0, or leave it out", "请写大于 0 的数"),
    ("race DURATION=0.0", "DURATION=0.0: write a number above 0", "请写大于 0 的数"),
    ("autorace SEEDS=0", "SEEDS=0: write a number above 0", "请写大于 0 的数"),
    ("avoid WORKERS='", "WORKERS=': write a whole number", "请写整数"),
    ("mark WORKER=2", "mark has no option WORKER=; is WORKERS meant?", "是不是想输入 WORKERS？"),
    ("zzz", "make has no command zzz; `make` alone lists them", "单独输入 `make` 会列出所有命令")])
def test_make_names_the_nearest_command_and_option(words: str, english: str, chinese: str) -> None:
    assert english in said(["make", *words.split()])
    assert chinese in said(["make", *words.split()], LANGUAGE="zh_CN", LC_ALL="C.UTF-8")


@pytest.mark.parametrize(("word", "told"), [
    ("PEOPLE=0 1", "PEOPLE=0 1: write 1 or 0"), ("SEED=1 2", "SEED=1 2: write a whole number"),
    ("METHOD=a\"b' $(id) $b$$c", "no method 'a\"b' $(id) $b$$c' (METHOD=)")])
def test_a_value_reaches_a_script_as_it_was_typed(word: str, told: str) -> None:
    assert told in said(["make", "lane", word])


def test_make_lists_what_a_learner_types_first() -> None:
    learners, developers = said(["make"]).split("For those who test or change this repository:")
    def listed(text: str) -> set[str]:
        return set(re.findall(r"^  ([a-z-]+)", text, re.MULTILINE))

    assert {"setup", "course", "race", "viewer", "drive", "mark"} <= listed(learners)
    assert {"fuzz", "chaos", "soak", "mutants", "bench", "track-trials"} <= listed(developers)
    assert not listed(learners) & listed(developers)
    assert all(ord(max(line)) > 0x3000 for line in said(["make"], LANG="zh_CN.UTF-8").splitlines())


def test_setup_writes_the_line_that_sources_into_bashrc(tmp_path: Path) -> None:
    def typed() -> tuple[int, str, list[str]]:
        done = subprocess.run(
            ["bash", "-c", '. scripts/common.sh; . scripts/setup/workspace.sh; source_in_bashrc'],
            cwd=ROOT, env=os.environ | {"HOME": str(tmp_path)}, text=True, capture_output=True,
            check=False)
        return done.returncode, done.stdout, (tmp_path / ".bashrc").read_text().splitlines()

    (tmp_path / ".bashrc").write_text(
        "alias l=ls\nsource /gone/devel/setup.bash  # ros1-driving-courses\n")
    line = f"{BASHRC}  # ros1-driving-courses"
    code, out, lines = typed()
    assert (code, lines) == (0, ["alias l=ls", line]) and out.startswith("Written into ")
    code, out, lines = typed()
    assert (code, lines) == (0, ["alias l=ls", line]) and "has this line already" in out
    (tmp_path / ".bashrc").write_text("alias l=ls")  # without a line end
    assert typed()[2] == ["alias l=ls", line]


@pytest.mark.parametrize(("built", "bashrc", "offers"), [
    ("yes", "alias l=ls", True), ("yes", f"{BASHRC}  # ros1-driving-courses", False),
    ("no", "alias l=ls", False)])
@pytest.mark.parametrize(("language", "begins"), [("en", "In each new"), ("zh_CN", "每个新终端")])
def test_setup_ends_with_what_to_type_in_each_terminal(
        tmp_path: Path, built: str, bashrc: str, offers: bool, language: str, begins: str) -> None:
    (tmp_path / ".bashrc").write_text(f"{bashrc}\n")
    script = (ROOT / "scripts/setup.sh").read_text()
    end = script[script.index('[ "$did" = yes ]'):]  # what is before takes minutes
    done = subprocess.run(
        ["bash", "-c", ". scripts/common.sh; . scripts/setup/workspace.sh; "
         f"did={built} build=yes bashrc=no; {end}"],
        cwd=ROOT, env=os.environ | {"HOME": str(tmp_path), "LANG": "C.UTF-8", "LC_ALL": "",
                                    "LANGUAGE": language},
        text=True, capture_output=True, check=False)
    last = done.stdout.splitlines()[-1]
    assert last.startswith(begins) == offers, done
    assert not offers or (TYPED in last and "BASHRC=1" in last)


@pytest.mark.parametrize("what", ["a folder", "a folder without a name"])
def test_a_bashrc_that_cannot_be_written_is_one_line(tmp_path: Path, what: str) -> None:
    home = tmp_path
    if what == "a folder":
        (home / ".bashrc").mkdir()
    else:
        home = tmp_path / "gone"
    done = subprocess.run(
        ["bash", "-c", ". scripts/common.sh; . scripts/setup/workspace.sh; source_in_bashrc"],
        cwd=ROOT, env=os.environ | {"HOME": str(home), "LC_ALL": "C"}, text=True,
        capture_output=True, check=False)
    line, = (done.stdout + done.stderr).splitlines()
    assert done.returncode and f"{home}/.bashrc cannot be written: type in each new" in line


def test_every_command_runs_without_options() -> None:
    verbs = re.findall(r"^  ([a-z-]+)", said(["make", "help"]), re.MULTILINE)
    assert len(verbs) > 20
    for verb in verbs:
        said(["make", "-n", verb])
