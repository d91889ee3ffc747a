"""On a Linux that is not Debian the scripts run in a Debian of their own: debian_root.sh."""

import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
DEBIAN = 'ID=debian\nPRETTY_NAME="Debian GNU/Linux {0}"\nVERSION_CODENAME={0}\n'
UBUNTU = 'ID=ubuntu\nID_LIKE=debian\nPRETTY_NAME="Ubuntu 24.04.1 LTS"\nVERSION_CODENAME=noble\n'
FEDORA = 'ID=fedora\nPRETTY_NAME="Fedora Linux 43"\nVERSION_CODENAME=""\n'


class Machine:
    """A copy of the scripts on a machine with another /etc/os-release, /var/lib and programs."""

    def __init__(self, folder: Path, os_release: str):
        self.folder, self.place = folder, folder / "var"
        self.programs = folder / "programs"
        self.programs.mkdir()
        shutil.copytree(ROOT / "scripts", folder / "scripts",
                        ignore=shutil.ignore_patterns("__pycache__"))
        (folder / "src").symlink_to(ROOT / "src")
        for release in ("bookworm-amd64", "trixie-amd64"):
            (folder / "dependencies" / release).mkdir(parents=True)
        (folder / "os-release").write_text(os_release)
        (folder / "debian-archive-keyring.gpg").touch()
        for script in (folder / "scripts").glob("*.sh"):
            text = script.read_text("utf-8")
            for old, new in (("/etc/os-release", f"{folder}/os-release"),
                             ("PATH=/usr/local/sbin", f"PATH={self.programs}:/usr/local/sbin"),
                             ("/var/lib/ros1-driving-courses", str(self.place)),
                             ("rule=/etc/sudoers.d/", f"rule={folder}/sudoers-"),
                             ("mktemp /tmp/", f"mktemp {folder}/"),
                             ("mktemp -d /tmp/", f"mktemp -d {folder}/"),
                             ("/usr/share/keyrings", str(folder))):
                text = text.replace(old, new)
            script.write_text(text)
        self.program("id", '[ "$*" = -u ] && echo 1000 || exec /usr/bin/id "$@"')
        self.program("visudo", 'echo "${@: -1}: parsed OK"')  # sudo-rs's says so also with -q
        self.program("debootstrap", 'for new in "$@"; do case $new in *.new) break;; esac; done\n'
                     'mkdir -p "$new/etc/apt" "$new/etc/sudoers.d"; echo "$@" > "$new/made"\n'
                     'echo "deb http://archive bookworm main" > "$new/etc/apt/sources.list"')
        # With its own variables; the installed program needs the rule.
        self.program("sudo", f'''
while [[ $1 == -* ]]; do case $1 in -kn) exit 1;; -n) [ "$2" = -l ] || {{ shift; continue; }}
  [ -e {folder}/sudoers-ros1-driving-courses ]; exit;; *) shift;; esac; done
exec env "$@"''')
        self.program("enter", "")

    def program(self, name: str, text: str) -> None:
        """A stand-in that the scripts find first."""
        path = self.programs / name
        path.write_text(f"#!/bin/bash\n{text}\n")
        path.chmod(0o755)

    def run(self, *words: str, **variables: str) -> subprocess.CompletedProcess:
        """scripts/WORD..."""
        return subprocess.run(
            [f"scripts/{words[0]}", *words[1:]], cwd=self.folder, text=True, capture_output=True,
            env={**os.environ, "LANGUAGE": "en", **variables}, timeout=60, check=False)

    def forget_what_root_does(self) -> None:
        """What is entered says how it was called, and its environment, instead."""
        (self.folder / "scripts/setup/enter_debian.sh").write_text(
            '#!/bin/bash\ntr "\\0" "\\n" < "$2" | grep "^GREETING"; rm "$2"; echo "$1" "${@:3}"\n')


@pytest.mark.parametrize("os_release", [DEBIAN.format("bookworm"), DEBIAN.format("trixie")])
def test_on_a_debian_that_is_served_nothing_is_entered(tmp_path, os_release):
    machine = Machine(tmp_path, os_release)
    (tmp_path / "scripts/course.sh").write_text("#!/bin/bash\n. scripts/common.sh; echo here\n")
    assert machine.run("course.sh").stdout == "here\n"


@pytest.mark.parametrize("os_release", [
    UBUNTU, FEDORA, DEBIAN.format("forky"), DEBIAN.format("bullseye"), ""])
def test_elsewhere_a_debian_is_made_once_and_the_script_runs_in_it(tmp_path, os_release):
    machine = Machine(tmp_path, os_release)
    machine.forget_what_root_does()
    first = machine.run("course.sh", "--laps", "2 3", GREETING="good day")
    assert first.returncode == 0, first.stderr
    entered = f"GREETING=good day\n{tmp_path} {tmp_path}/scripts/course.sh --laps 2 3\n"
    assert first.stdout.endswith(entered)
    assert "has no ROS 1: a Debian 12 goes into" in first.stdout
    made = (machine.place / "debian/made").read_text()
    assert f"--keyring={tmp_path}/debian-archive-keyring.gpg" in made and "bookworm" in made
    architecture = {"x86_64": "amd64", "aarch64": "arm64"}[os.uname().machine]
    assert f"--arch={architecture}" in made
    assert (machine.place / "debian/etc/apt/sources.list").read_text() == (
        "deb http://archive bookworm main\ndeb http://archive bookworm-updates main\n"
        "deb http://archive-security bookworm-security main\n")
    again = machine.run("course.sh", "--laps", "2 3", GREETING="good day")
    assert (again.returncode, again.stdout) == (0, entered)
    assert not list(tmp_path.glob("environment.*"))


def test_the_rule_lets_this_user_enter_without_a_password_and_do_nothing_else(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    assert machine.run("course.sh").returncode == 0
    user = subprocess.run(["id", "-un"], text=True, capture_output=True, check=True).stdout.strip()
    rule = (tmp_path / "sudoers-ros1-driving-courses").read_text().splitlines()
    assert rule[1] == f"{user} ALL=(root) NOPASSWD: {machine.place}/enter"
    # A second user is let in beside the first.
    machine.program("id", '[ "$*" = -u ] && echo 1000 || echo other')
    shutil.copy(machine.folder / "scripts/setup/enter_debian.sh", machine.place / "enter")
    (machine.place / "folders").write_text("")
    assert machine.run("course.sh").returncode == 0
    assert (tmp_path / "sudoers-ros1-driving-courses").read_text().splitlines() == [
        *rule, f"other ALL=(root) NOPASSWD: {machine.place}/enter"]
    # In there sudo asks as it does outside, where it did.
    inner = machine.place / "debian/etc/sudoers.d/ros1-driving-courses"
    assert inner.read_text() == f"{user} ALL=(ALL) ALL\nother ALL=(ALL) ALL\n"


def test_a_folder_that_is_not_in_there_yet_is_added(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    assert machine.run("course.sh", HOME="/opt/homes/one").returncode == 0
    before = (machine.place / "folders").read_text().splitlines()
    added = machine.run("course.sh", HOME="/schools/my home/two")
    assert added.returncode == 0
    assert added.stdout.splitlines()[:-1] == ["sudo asks for your password."]
    after = (machine.place / "folders").read_text().splitlines()
    assert "/opt" in before and set(after) == {*before, "/schools/my home/two"}


@pytest.mark.parametrize(("program", "text", "said"), [
    ("debootstrap", "echo 'E: No space left'; exit 1",
     "debootstrap could not make a Debian: E: No space left (full log: /"),
    ("debootstrap", "echo 'E: Failed getting release file http://x/Release'; exit 1",
     "var/log/debootstrap.log says more): connect, or correct MIRROR=, then type this again"),
    ("df", "printf 'x\\nx x x 100\\n'", "100 MB free, 3300 MB are needed"),
    ("sudo", "echo 'sudo: a password is required' >&2; exit 1", "a password is required"),
    ("uname", "echo riscv64", "needs Linux on a 64-bit Intel, AMD or ARM processor"),
    ("id", "echo 0", "is for a user with sudo, not for root; or use docker/ in this repository"),
])
def test_what_fails_is_said_and_the_next_call_goes_on(tmp_path, program, text, said):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    kept = (machine.programs / program).read_text() \
        if (machine.programs / program).exists() else None
    machine.program(program, text)
    done = machine.run("course.sh")
    assert done.returncode != 0 and said in done.stderr.splitlines()[-1]
    assert not (machine.place / "complete").exists()
    assert not list(tmp_path.glob("environment.*"))
    (machine.programs / program).unlink()
    if kept:
        machine.program(program, kept)
    assert machine.run("course.sh").returncode == 0


def test_where_there_is_no_sudo_one_line_says_so(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    (machine.programs / "sudo").unlink()
    for name in "awk basename bash cmp cut dirname env mktemp rm sed sort stat uname".split():
        (machine.programs / name).symlink_to(shutil.which(name))
    common = tmp_path / "scripts/common.sh"
    common.write_text(re.sub(r"(PATH=[^:]*):/usr/local/sbin.*", r"\1", common.read_text("utf-8")))
    done = machine.run("course.sh")
    assert done.returncode != 0 and not machine.place.exists()
    assert done.stderr == ("course: this is Ubuntu 24.04.1 LTS, where a Debian of its own is "
                           "needed, and there is no sudo; or use docker/ in this repository\n")


@pytest.mark.parametrize("roots_part_lives", [False, True])
def test_after_a_crash_in_the_middle_the_next_call_goes_on(tmp_path, roots_part_lives):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    debootstrap = (machine.programs / "debootstrap").read_text().partition("\n")[2]
    begun, go_on = tmp_path / "begun", tmp_path / "go-on"
    machine.program("debootstrap", f"""[ -e {begun} ] || mkdir -p {machine.place}/debian.new/half
        touch {begun}; for i in {{1..900}}; do [ -e {go_on} ] && break; sleep 0.1; done
        {debootstrap}""")
    course = {"args": "scripts/course.sh", "cwd": tmp_path, "stdout": subprocess.PIPE,
              "text": True, "env": {**os.environ, "LANGUAGE": "en"}}
    with subprocess.Popen(**course, start_new_session=True) as first:
        end = time.monotonic() + 60
        while not begun.exists() and time.monotonic() < end:
            time.sleep(0.02)
        if roots_part_lives:
            first.kill()
        else:
            os.killpg(first.pid, signal.SIGKILL)
            go_on.touch()
    second = subprocess.Popen(**course, stderr=subprocess.PIPE)
    lines = [second.stdout.readline() for _ in range(3 if roots_part_lives else 2)]
    go_on.touch()
    said, wrong = second.communicate(timeout=60)
    assert (second.returncode, wrong) == (0, "")
    assert said.endswith(f"{tmp_path}/scripts/course.sh\n")
    waited = "Another terminal is making this Debian: waiting for it.\n"
    assert (lines[-1] == waited) == roots_part_lives
    assert not (machine.place / "debian.new").exists()
    assert (machine.place / "debian/half").exists() == roots_part_lives


@pytest.mark.skipif(os.getuid() != 0, reason="root alone may mount and change its root folder")
@pytest.mark.parametrize("command", ["course.sh", "debian_root.sh --remove"])
def test_what_a_killed_debootstrap_mounted_is_unmounted(tmp_path, command):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    (machine.place / "debian.new/proc").mkdir(parents=True)
    done = subprocess.run(
        ["unshare", "-m", "bash", "-c", f'mount -t tmpfs none "$0" && scripts/{command}',
         machine.place / "debian.new/proc"], cwd=tmp_path, text=True, capture_output=True,
        timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert machine.place.exists() == (command == "course.sh")


def test_one_of_another_version_is_kept_and_entered_as_this_version_does(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    assert machine.run("course.sh").returncode == 0
    (machine.place / "debian/mine").touch()
    (machine.place / "enter").write_text("#!/bin/bash\necho of another version\n")
    done = machine.run("course.sh")
    assert done.stdout == (f"sudo asks for your password.\n"
                           f"{tmp_path} {tmp_path}/scripts/course.sh\n"), done.stderr
    assert (machine.place / "debian/mine").exists()


def test_it_is_made_where_root_may_not_read_this_folder_as_on_nfs(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    sudo = (machine.programs / "sudo").read_text().partition("\n")[2]
    machine.program("sudo", sudo.replace('exec env "$@"', """
        mv scripts hidden; env "$@"; rc=$?; mv hidden scripts; exit $rc""".replace(
            "scripts", f"{tmp_path}/scripts").replace("hidden", f"{tmp_path}/hidden")))
    done = machine.run("course.sh")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith(f"{tmp_path}/scripts/course.sh\n")
    assert not [*tmp_path.glob("environment.*"), *tmp_path.glob("debian-root.*")]


def test_a_folder_that_setup_refuses_is_refused_before_a_debian_is_made(tmp_path):
    folder = tmp_path / "course#1"
    folder.mkdir()
    machine = Machine(folder, UBUNTU)
    machine.forget_what_root_does()
    done = machine.run("course.sh")
    assert done.returncode != 0 and done.stderr.count("\n") == 1 and not machine.place.exists()
    assert "which catkin cannot handle: move the folder" in done.stderr


def test_without_a_network_the_package_manager_is_not_what_failed(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    (tmp_path / "debian-archive-keyring.gpg").unlink()
    machine.program("apt-get", """case "$*" in *update)
        echo "W: Failed to fetch http://x/InRelease  Could not resolve 'x'";;
        *) echo 'E: Unable to locate package debootstrap'; exit 100; esac""")
    done = machine.run("course.sh")
    assert "debootstrap-install.log says more): connect" in done.stderr.splitlines()[-1]


def test_ctrl_c_ends_it_without_a_word_and_the_next_call_goes_on(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    kept = (machine.programs / "debootstrap").read_text().partition("\n")[2]
    # As debootstrap does.
    machine.program("debootstrap", "trap 'echo E: Interrupt caught; exit 1' INT; kill -INT 0\n"
                    "sleep 9")
    done = subprocess.run(["setsid", "-w", "scripts/course.sh"], cwd=tmp_path, text=True,
                          capture_output=True, env={**os.environ, "LANGUAGE": "en"}, timeout=60,
                          check=False)
    assert done.returncode in (-2, 130) and done.stderr == ""
    assert not list(tmp_path.glob("environment.*"))
    machine.program("debootstrap", kept)
    assert machine.run("course.sh").returncode == 0


@pytest.mark.parametrize(("inside", "line", "written"), [
    (True, "make -sC {} shell", "alias courses='make -sC {} shell'  # ros1-driving-courses"),
    (False, "source {}/devel/setup.bash", "source {}/devel/setup.bash  # ros1-driving-courses")])
def test_a_terminal_of_the_machine_enters_by_a_word(tmp_path, inside, line, written):
    (tmp_path / ("inside" if inside else "outside")).touch()
    text = (ROOT / "scripts/setup/workspace.sh").read_text("utf-8")
    (tmp_path / "workspace.sh").write_text(
        text.replace("/etc/ros1-driving-courses", f"{tmp_path}/inside"))
    done = subprocess.run(
        ["bash", "-c", ". scripts/common.sh; . $1; terminal_line; source_in_bashrc", "bash",
         tmp_path / "workspace.sh"], cwd=ROOT, env={**os.environ, "HOME": str(tmp_path)},
        text=True, capture_output=True, check=True)
    assert done.stdout.splitlines()[0] == line.format(ROOT)
    assert (tmp_path / ".bashrc").read_text() == f"{written.format(ROOT)}\n"


@pytest.mark.parametrize(("language", "told"), [
    ("en", "This terminal has no ROS. One that has: make -sC {} shell\n"),
    ("zh_CN", "这个终端里没有 ROS。请输入：make -sC {} shell\n")])
def test_a_workspace_that_is_sourced_outside_says_where_to_type(tmp_path, language, told):
    (tmp_path / "devel").mkdir()
    sourced = tmp_path / "devel/setup.bash"
    sourced.write_text("echo sourced\n")
    shutil.copytree(ROOT / "scripts", tmp_path / "scripts")
    (tmp_path / "src").symlink_to(ROOT / "src")
    text = (ROOT / "scripts/setup/workspace.sh").read_text("utf-8")
    (tmp_path / "workspace.sh").write_text(
        text.replace("/etc/ros1-driving-courses", f"{tmp_path}/inside"))

    def run(words: str) -> subprocess.CompletedProcess:
        return subprocess.run(
            ["bash", "-c", words, "bash", tmp_path], text=True, capture_output=True, check=False,
            env={**os.environ, "LANGUAGE": language, "LANG": "C.UTF-8"})

    mark = 'root=$1; . "$1/workspace.sh"; refuse_other_terminals'
    assert run(mark).returncode == 0 and sourced.read_text() == "echo sourced\n"
    (tmp_path / "inside").touch()
    assert run(mark).returncode == 0
    assert run('. "$1/devel/setup.bash"').stdout == "sourced\n"
    (tmp_path / "inside").unlink()
    done = run('. "$1/devel/setup.bash"')
    assert (done.returncode, done.stdout, done.stderr) == (1, "", told.format(tmp_path))


@pytest.mark.parametrize(("os_release", "how"), [
    (UBUNTU, "make shell"), (DEBIAN.format("trixie"), "source devel/setup.bash")])
def test_the_list_of_commands_says_how_a_terminal_begins(tmp_path, os_release, how):
    machine = Machine(tmp_path, os_release)
    shutil.copy(ROOT / "Makefile", tmp_path)
    assert machine.run("help.sh").stdout.endswith(f"\nThen, in each new terminal: {how}\n")


def test_a_bug_report_is_written_where_there_is_no_python(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.program("python3", "echo python3: command not found >&2; exit 127")
    done = machine.run("report.sh")
    assert (done.returncode, done.stderr) == (0, "")
    assert "Ubuntu 24.04.1" in (tmp_path / "out/report.txt").read_text()


def test_it_is_removed_by_one_command(tmp_path):
    machine = Machine(tmp_path, UBUNTU)
    machine.forget_what_root_does()
    assert machine.run("course.sh").returncode == 0
    done = machine.run("debian_root.sh", "--remove")
    assert done.returncode == 0 and not machine.place.exists()
    assert not (tmp_path / "sudoers-ros1-driving-courses").exists()
    assert machine.run("debian_root.sh", "--remove").stdout == "There is no Debian to remove.\n"


def test_a_terminal_has_the_workspace_and_ends_quietly_after_a_command_that_failed():
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("ROS_", "MAKE", "PYTHON", "CMAKE_"))}
    done = subprocess.run(
        ["script", "-qec", "make -s shell", "/dev/null"], cwd=ROOT, text=True, timeout=120,
        input="rospack find learning_topic\nfalse\nexit\n", capture_output=True, check=False,
        env=environment | {"LANGUAGE": "en", "TERM": "dumb"})
    assert done.returncode == 0, done.stdout
    assert f"\n{ROOT}/src/learning_topic" in done.stdout.replace("\r", "")
    assert "***" not in done.stdout


@pytest.mark.skipif(os.getuid() != 0, reason="root alone may mount and change its root folder")
def test_who_enters_is_the_user_in_the_same_folders(tmp_path):
    debian = tmp_path / "debian"
    for folder in ("etc", "bin", "work"):
        (debian / folder).mkdir(parents=True)
    for name in ("passwd", "shadow", "group"):
        (debian / "etc" / name).write_text("nobody:old:line\n")
    programs = [Path(shutil.which(name)).resolve() for name in ("bash", "env", "id", "cat", "rm")]
    libraries = subprocess.run(["ldd", *programs], text=True, capture_output=True, check=True)
    needed = {word for word in libraries.stdout.split() if word.startswith("/") and word[-1] != ":"}
    for path in [*programs, *map(Path, needed)]:
        target = debian / "bin" / path.name if path in programs else debian / str(path)[1:]
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, target)
    (debian / "usr").mkdir(exist_ok=True)
    (debian / "usr/bin").symlink_to("../bin")
    mine = tmp_path / "my folder"
    mine.mkdir()
    (mine / "file").write_text("the machine's own\n")
    for folder in (tmp_path, *tmp_path.parents):
        folder.chmod(folder.stat().st_mode | 0o055) if folder.owner() == "root" and \
            folder.is_relative_to("/tmp/pytest-of-root") else None
    # Root's part follows no link: neither this user's, nor that of the Debian to its time zone.
    (tmp_path / "folders").write_text(f"{mine}\n{mine}/inner\n")
    (mine / "inner").symlink_to("../" * (len(mine.parts) - 1) + "etc")
    (debian / "etc/in-there").touch()
    (debian / "etc/localtime").symlink_to(tmp_path / "zone")
    enter = tmp_path / "enter"
    shutil.copy(ROOT / "scripts/setup/enter_debian.sh", enter)
    environment = mine / "environment"
    environment.write_bytes(b"GREETING=good day\0PATH=/bin\0")
    os.chown(environment, 65534, 65534)
    os.chown(mine, 65534, 65534)
    done = subprocess.run(
        [enter, mine, environment, "bash", "-c",
         'id -u; pwd; cat file; echo "$GREETING"; [ -e /etc/in-there ] && exit 7'],
        env={"SUDO_UID": "65534"}, text=True, capture_output=True, timeout=60, check=False)
    assert done.stdout.splitlines() == ["65534", str(mine), "the machine's own", "good day"], \
        done.stderr
    assert done.returncode == 7 and not environment.exists()
    assert not os.path.ismount(debian / str(mine)[1:])
    assert ":/bin/bash\n" in (debian / "etc/passwd").read_text()
    assert "old" not in (debian / "etc/passwd").read_text()
    assert not (tmp_path / "zone").exists()
    seen = subprocess.run(
        ["unshare", "--mount", "bash", "-c", '"$@"; grep -c "$0" /proc/self/mounts', debian,
         enter, "mounted", mine, environment, "true"],
        env={"SUDO_UID": "65534"}, text=True, capture_output=True, timeout=60, check=False)
    assert seen.stdout == "0\n"  # whatever its words, its mounts are its own
    refused = subprocess.run([enter, "/", "x", "true"], env={}, text=True, capture_output=True,
                             check=False)
    assert refused.returncode == 2 and "by sudo" in refused.stderr
