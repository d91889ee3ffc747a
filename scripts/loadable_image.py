"""Packs an OCI layout as an archive that every Docker loads (docker save writes such, too).

    loadable_image.py FOLDER ARCHIVE

Docker's own store of images reads no OCI layout, but manifest.json: the image's configuration and
its layers, which may be compressed, and its names. containerd's takes the names from annotations.
"""

import json
import sys
import tarfile
from pathlib import Path

NAME = "org.opencontainers.image.ref.name"  # as buildah writes it: NAME:TAG


def pack(layout: Path, archive: Path) -> None:
    """Pack the one image that the layout has under one or more names."""
    index = json.loads((layout / "index.json").read_text(encoding="utf-8"))
    names = [image["annotations"][NAME] for image in index["manifests"]]
    (digest,) = {image["digest"] for image in index["manifests"]}
    for image, name in zip(index["manifests"], names):
        image["annotations"]["io.containerd.image.name"] = f"docker.io/library/{name}"
    manifest = json.loads((layout / _blob(digest)).read_text(encoding="utf-8"))
    docker = [{"Config": _blob(manifest["config"]["digest"]), "RepoTags": names,
               "Layers": [_blob(layer["digest"]) for layer in manifest["layers"]]}]
    for name, content in (("index.json", index), ("manifest.json", docker)):
        (layout / name).write_text(json.dumps(content), encoding="utf-8")
    with tarfile.open(archive, "w") as tar:
        for entry in sorted(layout.iterdir()):
            tar.add(entry, entry.name)


def _blob(digest: str) -> str:
    return "blobs/" + digest.replace(":", "/")


if __name__ == "__main__":
    pack(Path(sys.argv[1]), Path(sys.argv[2]))
