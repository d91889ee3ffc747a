""".github/workflows and the scripts of a release, as far as can be seen without that service."""

import importlib.util
import json
import os
import re
import subprocess
import tarfile
from importlib.metadata import files
from pathlib import Path

import jsonschema
import pytest
import yaml

from bullet_sim import __version__

ROOT = Path(__file__).resolve().parent.parent
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))
VERBS = re.findall(r"^([a-z-]+):.*##", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)


def jobs(workflow: Path) -> dict:
    return yaml.safe_load(workflow.read_text(encoding="utf-8"))["jobs"]


def script(name: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run([ROOT / "scripts" / name, *arguments], text=True, capture_output=True,
                          check=False, env={"PATH": "/usr/bin:/bin", "LANG": "C.UTF-8",
                                            **environment})


def test_the_files_are_what_the_service_reads() -> None:
    (schema,) = [file for file in files("check-jsonschema") if file.name == "github-workflows.json"]
    check = jsonschema.Draft7Validator(json.loads(schema.locate().read_text(encoding="utf-8")))
    assert len(WORKFLOWS) == 2
    for workflow in WORKFLOWS:
        check.validate(yaml.safe_load(workflow.read_text(encoding="utf-8")))
    with pytest.raises(jsonschema.ValidationError):
        check.validate({"on": "push", "jobs": {"test": {"runs-on": "x", "step": []}}})


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_each_step_is_a_command_of_this_repository(workflow: Path) -> None:
    own = 0
    for job in jobs(workflow).values():
        assert set(re.findall(r"\w+", str(job.get("needs", "")))) <= set(jobs(workflow))
        for run in [step["run"] for step in job["steps"] if "run" in step]:
            for verb in re.findall(r"\bmake ([a-z-]+)", run.replace("git make", "")):
                assert verb in VERBS, run
                own += 1
            for path in re.findall(r"(?:scripts/|\.ci/)\w+(?:\.sh)?", run):
                assert os.access(ROOT / path, os.X_OK), run
                own += 1
    assert own


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_what_others_made_has_a_version_and_few_rights(workflow: Path) -> None:
    uses = [step["uses"] for job in jobs(workflow).values() for step in job["steps"]
            if "uses" in step]
    assert uses and all(re.fullmatch(r"actions/[\w-]+@v\d+", name) for name in uses)
    assert yaml.safe_load(workflow.read_text(encoding="utf-8"))["permissions"] == {
        "contents": "read"}


def test_all_releases_and_architectures_are_built() -> None:
    release = jobs(ROOT / ".github/workflows/release.yml")
    lists = {path.name for path in (ROOT / "dependencies").iterdir() if path.is_dir()}
    for name in ("deb", "image"):
        matrix = release[name]["strategy"]["matrix"]
        assert {f"{suite}-{'arm64' if machine.endswith('arm') else 'amd64'}"
                for suite in matrix["suite"] for machine in matrix["machine"]} == lists
    assert set(release["publish"]["needs"]) == {"deb", "image", "wheels", "site"}


def test_the_notes_of_a_release_are_its_part_of_the_changelog() -> None:
    notes = script("release_notes.sh", f"v{__version__}")
    assert notes.returncode == 0 and "**" in notes.stdout and "\n## " not in notes.stdout
    assert notes.stdout.strip() in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("tag", ("", "v0.9.0", __version__, f"v{__version__}-rc1"))
def test_a_tag_is_the_version(tag: str) -> None:
    refused = script("release_notes.sh", tag)
    assert refused.returncode == 1 and not refused.stdout
    assert refused.stderr == (f"release_notes: the tag is '{tag}', but the version is "
                              f"{__version__}: tag v{__version__}, or change __version__\n")


def test_an_image_needs_a_release_that_is_there() -> None:
    refused = script("image.sh", "--suite", "noble")
    assert refused.returncode == 1
    assert refused.stderr == "image: SUITE=noble: there are bookworm and trixie\n"


@pytest.mark.parametrize("words", (["--suite"], ["trixie"], ["--suite", "trixie", "--now"]))
def test_an_image_takes_one_option(words: list[str]) -> None:
    refused = script("image.sh", *words)
    assert refused.returncode == 1 and refused.stderr.startswith(
        ("image: unknown option", "image: SUITE="))


def test_what_packages_come_from_reaches_the_image(tmp_path: Path) -> None:
    buildah = f'buildah() {{ echo "$@" >{tmp_path}/used; exit 1; }}; export -f buildah; '
    subprocess.run(["bash", "-c", f"{buildah} exec {ROOT}/scripts/image.sh"], check=False,
                   env={**os.environ, "MIRROR": "cn", "PIP_INDEX_URL": "http://index"})
    used = (tmp_path / "used").read_text(encoding="utf-8")
    assert "--build-arg MIRROR=cn" in used and "--build-arg PIP_INDEX_URL=http://index" in used


def test_a_file_that_is_not_there_is_named_before_anything_is_pushed(tmp_path: Path) -> None:
    buildah = tmp_path / "buildah"
    buildah.write_text(f"#!/bin/sh\necho used >>{tmp_path}/used\n", encoding="utf-8")
    buildah.chmod(0o755)
    text = (ROOT / "scripts/publish_images.sh").read_text(encoding="utf-8")
    tried = tmp_path / "scripts/publish_images.sh"
    tried.parent.mkdir()
    tried.write_text(text, encoding="utf-8")
    common = (ROOT / "scripts/common.sh").read_text(encoding="utf-8")
    (tmp_path / "scripts/common.sh").write_text(f"{common}\nPATH={tmp_path}:$PATH\n",
                                                encoding="utf-8")
    (tmp_path / "src").symlink_to(ROOT / "src")
    there = tmp_path / "there.tar"
    there.touch()
    refused = subprocess.run(["bash", tried, "oci:x", "bookworm", there, "none.tar"], text=True,
                             capture_output=True, check=False)
    assert refused.returncode == 1 and "there is no none.tar" in refused.stderr
    assert not (tmp_path / "used").exists()


def test_an_archive_has_all_names_by_which_docker_loads_it(tmp_path: Path) -> None:
    spec = importlib.util.spec_from_file_location("loadable", ROOT / "scripts/loadable_image.py")
    loadable = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loadable)
    blobs = {name: f"sha256:{number:064x}" for number, name in
             enumerate(("manifest", "config", "first", "second"))}
    paths = {name: f"blobs/{digest.replace(':', '/')}" for name, digest in blobs.items()}
    layout = tmp_path / "layout"
    (layout / "blobs/sha256").mkdir(parents=True)
    (layout / paths["manifest"]).write_text(json.dumps({
        "config": {"digest": blobs["config"]},
        "layers": [{"digest": blobs["first"]}, {"digest": blobs["second"]}]}), encoding="utf-8")
    (layout / "index.json").write_text(json.dumps({"manifests": [
        {"digest": blobs["manifest"], "annotations": {loadable.NAME: name}}
        for name in ("courses:1", "courses:new")]}), encoding="utf-8")
    loadable.pack(layout, tmp_path / "image.tar")
    with tarfile.open(tmp_path / "image.tar") as tar:
        (entry,) = json.load(tar.extractfile("manifest.json"))
        index = json.load(tar.extractfile("index.json"))["manifests"]
        assert paths["manifest"] in tar.getnames()
    assert entry == {"Config": paths["config"], "RepoTags": ["courses:1", "courses:new"],
                     "Layers": [paths["first"], paths["second"]]}
    assert [image["annotations"]["io.containerd.image.name"] for image in index] == [
        "docker.io/library/courses:1", "docker.io/library/courses:new"]
