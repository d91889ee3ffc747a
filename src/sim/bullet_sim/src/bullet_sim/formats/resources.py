"""Finds the files for `model://`, `package://`, `file://` and plain names."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from urllib.parse import unquote

from bullet_sim.errors import ResourceNotFound, nearest_file

DATA_FOLDER = Path(__file__).resolve().parent.parent / "data"
RESOURCE_SUBFOLDERS = ("", "models", "media/models", "Media/models")

FindPackage = Callable[[str], str]


class Resources:
    """Search paths of a simulator. `find_package` returns a package's folder or raises."""

    def __init__(
        self,
        model_paths: Iterable[str | Path] = (),
        resource_paths: Iterable[str | Path] = (),
        find_package: FindPackage | None = None,
    ):
        self.model_paths = _unique(model_paths)
        self.resource_paths = _unique(resource_paths)
        self._find_package = find_package

    @classmethod
    def from_environment(
        cls,
        environ: Mapping[str, str] = os.environ,
        extra_model_paths: Iterable[str | Path] = (),
        extra_resource_paths: Iterable[str | Path] = (),
        find_package: FindPackage | None = None,
    ) -> Resources:
        """Home, our own folders, the environment's, then those exported by packages.

        The variables are those of Gazebo's SystemPaths.cc.
        """
        home = Path(environ.get("HOME") or Path.home())
        models = [home / ".gazebo" / "models", DATA_FOLDER / "models"]
        return cls(
            [*models, *_listed(environ, "GAZEBO_MODEL_PATH"), *extra_model_paths],
            [DATA_FOLDER, *_listed(environ, "GAZEBO_RESOURCE_PATH"), *extra_resource_paths],
            find_package,
        )

    def resolve(self, uri: str, base: Path | None = None) -> Path:
        """The existing file or folder for a URI; `base` is the folder of the text that contains it.

        If it does not exist as written, it is searched for with `%20` etc. decoded and `\\` as `/`.
        ResourceNotFound names the searched folders.
        """
        written = uri.strip()
        try:
            return self._as_written(written, base)
        except ResourceNotFound:
            meant = unquote(written.replace("\\", "/"))
            if meant == written:
                raise
            return self._as_written(meant, base)

    def _as_written(self, uri: str, base: Path | None) -> Path:
        scheme, separator, rest = uri.partition("://")
        if not separator:
            return self._first(uri, self._plain_candidates(uri, base))
        if scheme == "model":
            return self._first(uri, [folder / rest.lstrip("/") for folder in self.model_paths])
        if scheme == "package":
            package, _, inside = rest.partition("/")
            return self._first(uri, [self.package_folder(package) / inside])
        if scheme == "file":
            return self._first(uri, self._plain_candidates(rest, base))
        if scheme in ("http", "https", "fuel"):
            raise ResourceNotFound(uri, ["nowhere. Unknown URI prefix: nothing is downloaded; "
                                         "put the files into a folder of GAZEBO_MODEL_PATH and "
                                         "write model://NAME"])
        raise ResourceNotFound(uri, ["nowhere. Unknown URI prefix; known: model package file"])

    def find_world(self, name: str) -> Path:
        """A world file: as given, else under the resource paths.

        ResourceNotFound lists the available ones.
        """
        try:
            return self._first(name, self._plain_candidates(name, Path.cwd()))
        except ResourceNotFound as error:
            there = {str(path) for path in Path(name).parent.glob("*.world")}
            if not os.path.isabs(name) or not there:
                there = {f"worlds/{path.name}" for folder in self.resource_paths
                         for path in (folder / "worlds").glob("*.world")}
            raise ResourceNotFound(name, error.searched, sorted(there), error.hint) from None

    def package_folder(self, package: str) -> Path:
        """Folder of a ROS package. ResourceNotFound if the package finder does not find it."""
        if self._find_package is None:
            raise ResourceNotFound(f"package {package}", ["no package finder was given"])
        try:
            found = self._find_package(package)
        except Exception as error:  # a finder may raise exceptions of its own
            raise ResourceNotFound(f"package {package}", [str(error)]) from error
        if not found:
            raise ResourceNotFound(f"package {package}", ["the package path"])
        return Path(found)

    def _plain_candidates(self, name: str, base: Path | None) -> list[Path]:
        path = Path(os.path.expanduser(name))
        if path.is_absolute():
            return [path]
        nearby = [base / path] if base is not None else []
        return nearby + [
            folder / sub / path
            for folder in self.resource_paths
            for sub in RESOURCE_SUBFOLDERS
            if (folder / sub).is_dir()
        ]

    @staticmethod
    def _first(uri: str, candidates: list[Path]) -> Path:
        for candidate in candidates:
            if os.path.exists(candidate):  # Path.exists raises for a name that is too long
                return Path(os.path.abspath(candidate))
        raise ResourceNotFound(uri, dict.fromkeys(str(path.parent) for path in candidates),
                               hint=_nearest(candidates))


def _nearest(candidates: list[Path]) -> str:
    """The end of a line: the name most like the wrong part of the path that exists the farthest."""
    wrong = [(next(part for part in (path, *path.parents) if os.path.isdir(part.parent)), path)
             for path in candidates]
    wrong.sort(key=lambda both: len(both[1].parts) - len(both[0].parts))
    return next(filter(None, (nearest_file(part) for part, _ in wrong)), "")


def _listed(environ: Mapping[str, str], variable: str) -> list[str]:
    return [folder for folder in environ.get(variable, "").split(":") if folder]


def _unique(folders: Iterable[str | Path]) -> tuple[Path, ...]:
    return tuple(dict.fromkeys(Path(folder) for folder in folders))
