"""The core's exceptions: one line each, saying what is wrong, where, and what is available."""

import difflib
import os
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

LINE_BREAK = re.compile(r"\s*[\n\r\v\f\x1c-\x1e\x85\u2028\u2029]\s*")  # those of str.splitlines
MOST_NAMES = 6  # of folders, or of files that there are
LONGEST_LINE = 900  # characters: a name in a file, or a list of names, may have any length


def shortened(text: str, longest: int = LONGEST_LINE) -> str:
    """One line; if too long only both ends, which say what is wrong and what to do about it."""
    text = LINE_BREAK.sub(" ", text)
    half = longest // 2
    return text if len(text) <= longest else f"{text[:half]} … {text[-half:]}"


class SimulationError(Exception):
    """Base class of all errors that the simulator core raises on purpose."""

    def __str__(self) -> str:
        return shortened(super().__str__())


class PluginError(SimulationError):
    """A plugin that cannot work as written; the message names the tag."""


class FormatError(SimulationError):
    """A model, world, material or xacro text is invalid."""


@contextmanager
def prefixed(text: str, kind: type[SimulationError] = FormatError) -> Iterator[None]:
    """Turn errors of the `with` block into this type, with this text at the start of the line."""
    try:
        yield
    except SimulationError as error:
        raise kind(f"{text} {error}") from None


def did_you_mean(word: str, known: Iterable[str], alike: float, form: str = "{}") -> str:
    """The end of a line: the nearest known word, if its similarity (0..1) is at least `alike`."""
    close = difflib.get_close_matches(word, known, 1, alike)
    return f" (did you mean {form.format(close[0])}?)" if close else ""


def nearest_file(path: Path | str) -> str:
    """The end of a line on a missing file: the one in its folder whose name is most like it."""
    path = Path(path)
    try:
        beside = os.listdir(path.parent)
    except OSError:
        return ""
    return _file_meant(path.name, beside)


def _file_meant(name: str, known: Iterable[str]) -> str:
    """The end of a line; names are alike by what stands before their suffixes, mostly the same."""
    stem = Path(name).stem
    alike = [each for each in known
             if difflib.SequenceMatcher(None, Path(each).stem, stem).ratio() > 0.65]
    return did_you_mean(name, alike, 0.0)


def _some(names: Sequence[str]) -> str:
    """The first of them: a line that names all would be cut in its midst."""
    return ", ".join([*names[:MOST_NAMES], "…"] if len(names) > MOST_NAMES else names)


class ResourceNotFound(SimulationError):
    """A URI or file name is in none of the searched folders; `hint`: the end of a line."""

    def __init__(self, uri: str, searched: Iterable[str] = (), known: Iterable[str] = (),
                 hint: str = ""):
        self.uri = uri
        self.hint = hint
        self.searched = tuple(str(place) for place in searched)
        places = _some(self.searched) or "nowhere to look"
        by_name = {Path(name).name: name for name in known}
        nearest = difflib.get_close_matches(Path(uri).name, by_name, len(by_name) or 1, 0.0)
        there_are = f"; there are: {_some([by_name[name] for name in nearest])}" if by_name else ""
        super().__init__(f"{uri} not found (searched: {places})"
                         f"{hint or _file_meant(Path(uri).name, by_name)}{there_are}")


class UnknownName(SimulationError):
    """A model, link or joint does not exist."""

    def __init__(self, kind: str, name: str, known: Iterable[str]):
        self.kind, self.name, self.known = kind, name, tuple(known)
        super().__init__(f"no {kind} named {name!r}; there are: {', '.join(self.known) or 'none'}")


def check_lengths(geometry: object, *names: str) -> None:
    """Raise SimulationError for a field of these names (m) that is not above 0."""
    for name in names:
        value = getattr(geometry, name)
        if not value > 0.0:
            raise SimulationError(f"{name} is {value:g} m; it must be above 0")
