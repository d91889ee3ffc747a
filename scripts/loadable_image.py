"""Adds manifest.json to an OCI archive, so that every Docker loads it (docker save writes both).

    loadable_image.py ARCHIVE NAME:TAG...

Docker's own store of images reads no OCI layout, but only this list: the image's configuration and
its layers, which may be compressed, and the names that it gets.
"""

import io
import json
import sys
import tarfile


def add_manifest(archive: str, names: list[str]) -> None:
    """Append manifest.json to the archive of one image. Raises KeyError if it is no OCI layout."""
    def blob(digest: str) -> str:
        return "blobs/" + digest.replace(":", "/")

    with tarfile.open(archive) as tar:
        def read(path: str) -> dict:
            return json.load(tar.extractfile(path))
        (image,) = read("index.json")["manifests"]
        manifest = read(blob(image["digest"]))
    layers = [blob(layer["digest"]) for layer in manifest["layers"]]
    text = json.dumps([{"Config": blob(manifest["config"]["digest"]), "RepoTags": names,
                        "Layers": layers}]).encode()
    entry = tarfile.TarInfo("manifest.json")
    entry.size = len(text)
    with tarfile.open(archive, "a") as tar:
        tar.addfile(entry, io.BytesIO(text))


if __name__ == "__main__":
    add_manifest(sys.argv[1], sys.argv[2:])
