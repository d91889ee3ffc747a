"""docker/ and .devcontainer/, as far as can be seen without a Docker engine."""

import json
import os
import re
import shutil
import subprocess
import tempfile
from importlib.metadata import files
from pathlib import Path

import jsonschema
import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
LIST = "dependencies/bookworm-amd64/requirements.txt"
STRANGER = 54321  # a user that no /etc/passwd knows
COMPOSE = yaml.safe_load((ROOT / "docker/compose.yaml").read_text(encoding="utf-8"))
DOCKERFILE = (ROOT / "docker/Dockerfile").read_text(encoding="utf-8")
ENTRYPOINT = (ROOT / "docker/entrypoint.sh").read_text(encoding="utf-8")
DOCS = ("docs/docker.md", "docs/docker.zh-CN.md", "README.md", "README.zh-CN.md")


def test_the_compose_file_is_what_the_specification_says() -> None:
    (schema,) = [file for file in files("check-jsonschema") if file.name == "compose-spec.json"]
    check = jsonschema.Draft202012Validator(
        json.loads(schema.locate().read_text(encoding="utf-8")))
    check.validate(COMPOSE)
    for wrong in ({"ports": 8080}, {"volume": ["..:/repository"]}):
        with pytest.raises(jsonschema.ValidationError):
            check.validate({"services": {"course": wrong}})


@pytest.mark.parametrize("name", DOCS)
def test_every_documented_command_is_there(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    commands = re.findall(r"docker compose -f docker/compose\.yaml ([^`#\n]+)", text)
    assert commands
    for words in commands:
        verb, *rest = words.split()
        service = rest[-1] if rest else None
        assert verb in ("run", "up", "build", "down"), words
        assert rest[:-1] == (["--rm"] if verb == "run" else []), words
        assert service in {"build": (None,), "down": (None,)}.get(verb, COMPOSE["services"]), words


@pytest.mark.parametrize("name", ("docs/workers.md", "docs/workers.zh-CN.md"))
def test_an_image_that_a_page_names_is_built(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    images = re.findall(r"^docker run (?:--\w+ (?:host )?)*(\S+)", text, re.MULTILINE)
    built = {re.sub(r"\$\{\w+:-(.*?)\}", r"\1", service["image"])  # the defaults
             for service in COMPOSE["services"].values()}
    assert images and set(images) <= built


def test_the_page_is_published_to_this_machine_alone() -> None:
    published = [port for service in COMPOSE["services"].values()
                 for port in service.get("ports", [])]
    assert published == ["127.0.0.1:${PORT:-8080}:8080", "127.0.0.1:${LAB_PORT:-8888}:8888"]


def test_every_terminal_is_in_the_network_of_the_world() -> None:
    for name, network in (("viewer", "network"), ("shell", "network"), ("lab", "lab-network")):
        service = COMPOSE["services"][name]
        assert service["network_mode"] == f"service:{network}" and network in service["depends_on"]
        # The engine refuses both where a container takes another's network.
        assert not {"hostname", "ports"} & set(service)


def test_what_a_person_edits_is_what_runs_and_what_is_built_is_the_images() -> None:
    mounts = dict(mount.split(":")[:2] for mount in COMPOSE["services"]["shell"]["volumes"])
    assert all((ROOT / "docker" / folder).is_dir() for folder in mounts), mounts
    assert mounts["../src"] == "/home/learner/ws/src" and mounts["../out"].endswith("/ws/out")
    assert not [place for place in mounts.values()
                if Path(place).name in ("ws", ".venv", ".setup", "build", "devel")]


def test_the_image_has_fixed_bases_and_no_way_to_become_root() -> None:
    bases = re.findall(r"^FROM (\S+:\S+)", DOCKERFILE, re.MULTILINE)
    assert len(bases) == 2
    assert all(re.fullmatch(r"debian:\w+-slim@sha256:[0-9a-f]{64}", base) for base in bases)
    installed = [line for lists in ROOT.glob("dependencies/*/debian*.txt")
                 for line in lists.read_text(encoding="utf-8").splitlines()]
    assert len(installed) > 400 and not [line for line in installed if line.startswith("sudo")]
    assert "sudo" not in DOCKERFILE
    assert not re.search(r"^[^#'\"]*\bchown\b", ENTRYPOINT, re.MULTILINE)


def test_the_editors_container() -> None:
    settings = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text(encoding="utf-8"))
    build = settings["build"]
    dockerfile = (ROOT / ".devcontainer" / build["dockerfile"]).read_text(encoding="utf-8")
    assert f"AS {build['target']}\n" in dockerfile
    assert (ROOT / ".devcontainer" / build["context"]).resolve() == ROOT
    assert re.search(rf"useradd .*{settings['remoteUser']}\b", dockerfile)
    assert os.access(ROOT / settings["updateContentCommand"].split()[0], os.X_OK)
    assert settings["forwardPorts"] == [8080]
    named = " ".join(settings["customizations"]["vscode"]["extensions"])
    assert "python" in named and "debugpy" in named and "ros" in named


@pytest.fixture
def container():
    """A folder for /, with an image's workspace and the repository that is mounted into it."""
    root = Path(tempfile.mkdtemp(prefix="docker-test-"))  # a stranger may not enter tmp_path
    root.chmod(0o755)
    repository, ws = root / "repository", root / "ws"
    (repository / "src").mkdir(parents=True)
    (repository / "scripts").mkdir()
    (repository / "out").mkdir()
    shutil.copy(ROOT / ".dockerignore", repository)
    shutil.copytree(ROOT / "dependencies", repository / "dependencies")
    shutil.copytree(ROOT / "docker", repository / "docker")
    shutil.copytree(repository, ws)
    lists = subprocess.run([ws / "docker/lists.sh", ws], check=True, capture_output=True).stdout
    (root / "workspace-lists").write_bytes(lists)
    for mounted in ("src", "scripts", "out"):
        shutil.rmtree(ws / mounted)
        (ws / mounted).symlink_to(repository / mounted)
    (ws / "devel").mkdir()
    (ws / "devel/setup.bash").write_text("export SOURCED=yes\n")
    (root / "passwd").write_text("learner:x:1000:1000::/home/learner:/bin/bash\n")
    for folder in (ws, root / "home"):
        folder.mkdir(exist_ok=True)
        folder.chmod(0o777)
    entry = ENTRYPOINT
    for place, ours in {"/home/learner/ws": ws, "/etc/passwd": root / "passwd",
                        "/usr/local/share/workspace-lists": root / "workspace-lists",
                        "repository=/repository": f"repository={repository}"}.items():
        assert place in entry
        entry = entry.replace(place, str(ours))
    (ws / "docker/entrypoint.sh").write_text(entry)
    yield root
    shutil.rmtree(root)


def enter(root: Path, command: str) -> subprocess.CompletedProcess:
    return subprocess.run([root / "ws/docker/entrypoint.sh", "bash", "-c", command], text=True,
                          capture_output=True, env={"PATH": os.environ["PATH"],
                                                    "HOME": str(root / "home")})


def test_a_command_runs_in_the_workspace(container: Path) -> None:
    done = enter(container, 'echo "$SOURCED $PWD $USER"; touch "$HOME/written"; exit 3')
    assert (done.returncode, done.stderr) == (3, "")
    assert done.stdout.split()[:2] == ["yes", str(container / "ws")] and done.stdout.split()[2]


@pytest.mark.skipif(os.getuid() != 0, reason="only root becomes another user, as in a container")
def test_what_is_written_belongs_to_the_owner_of_the_source(container: Path) -> None:
    for path in [container / "repository", *(container / "repository").rglob("*")]:
        os.chown(path, STRANGER, STRANGER)
    done = enter(container, 'id -u; id -g; id -G; touch out/here; touch "$HOME/there"; echo $USER')
    assert done.stdout.split()[:3] == [str(STRANGER)] * 3, done.stderr
    assert done.stdout.split()[3:] == ["learner"]
    written = (container / "repository/out/here").stat()
    assert (written.st_uid, written.st_gid) == (STRANGER, STRANGER)
    assert f"learner:x:{STRANGER}:{STRANGER}:" in (container / "passwd").read_text()


@pytest.mark.skipif(os.getuid() != 0, reason="only root becomes another user, as in a container")
def test_a_folder_of_somebody_else_is_left_alone_with_one_line(container: Path) -> None:
    for path in (container / "repository").rglob("*"):
        os.chown(path, STRANGER, STRANGER)
    os.chown(container / "repository/out", 0, 0)
    done = enter(container, "true")
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert f"type: sudo chown -R {STRANGER}:{STRANGER} out" in done.stderr
    assert (container / "repository/out").stat().st_uid == 0


def test_another_user_builds_from_the_beginning() -> None:
    """CMake may not set the modes of files that the image's maker left."""
    setup = (ROOT / "scripts/setup/workspace.sh").read_text(encoding="utf-8")
    assert re.search(r'! -O "\$root/build".*rm -rf "\$root/build" "\$root/devel"', setup)


def test_a_changed_list_asks_for_a_new_image(container: Path) -> None:
    with (container / f"repository/{LIST}").open("a") as file:
        file.write("one-more==1.0\n")
    done = enter(container, "true")
    assert (done.returncode, done.stderr) == (2, (
        f"docker: {LIST} is not what this image was made from; "
        "type: docker compose -f docker/compose.yaml build\n"))


def test_files_beside_the_folders_are_the_hosts(container: Path) -> None:
    (container / "repository/Makefile").write_text("new\n")
    assert enter(container, "cat Makefile").stdout == "new\n"


@pytest.mark.skipif(os.getuid() != 0, reason="only root becomes another user, as in a container")
def test_files_that_nobody_may_read_are_left_out(container: Path) -> None:
    for path in [container / "repository", *(container / "repository").rglob("*")]:
        os.chown(path, STRANGER, STRANGER)
    secret = container / "repository/.env"
    secret.write_text("secret\n")
    secret.chmod(0o600)
    assert enter(container, "ls -A").stderr == ""
    assert not (container / "ws/.env").exists()


def test_what_editors_and_hosts_leave_in_docker_asks_for_nothing(container: Path) -> None:
    for name in (".DS_Store", "Dockerfile~", ".Dockerfile.swp", "compose.override.yaml"):
        (container / "repository/docker" / name).write_text("x")
    done = enter(container, "true")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(os.getuid() != 0, reason="only root becomes another user, as in a container")
def test_a_workspace_that_cannot_be_written_is_one_line(container: Path) -> None:
    for path in [container / "repository", *(container / "repository").rglob("*")]:
        os.chown(path, STRANGER, STRANGER)
    (container / "ws").chmod(0o755)
    done = enter(container, "true")
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert "writable file system" in done.stderr
