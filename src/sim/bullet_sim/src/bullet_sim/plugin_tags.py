"""Reads the tags of a `<plugin>`: types, defaults, and errors that name plugin and tag."""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from xml.etree.ElementTree import Element

from bullet_sim.description import PluginDescription
from bullet_sim.errors import PluginError

log = logging.getLogger("bullet_sim.plugins")

TRUE, FALSE = ("true", "1"), ("false", "0")
# The part that a C++ stream reads: 1.5f, 0.3m and 1,5 are 1.5, 0.3 and 1, and 0x10 is 0.
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE)
WORDS = ("inf", "nan", "infinity")  # unknown to a C++ stream, but written by xacro and Python


def _read_numbers(text: str, count: int) -> tuple[list[float], bool]:
    """The numbers at the beginning of a text, `count` at most, and whether they are all of it.

    Reading ends at the first word that is not a number.
    """
    values: list[float] = []
    for word in text.split():
        if len(values) == count:
            return values, False
        if word.lower().lstrip("+-") in WORDS:
            values.append(float(word))
            continue
        found = NUMBER.match(word)
        if not found:
            return values, False
        values.append(float(found.group()))
        if found.end() < len(word):
            return values, False
    return values, True


class PluginParameters:
    """Typed access to the children of one `<plugin>` element."""

    def __init__(self, model: str, description: PluginDescription, path: tuple[str, ...] = ()):
        """`path`: the tags around those of a group."""
        self._path = path
        self._warned: set[str] = set()  # tags
        self._model = model
        self._description = description
        self._plugin = description.name
        self._element = description.element
        self._groups: dict[str, list[PluginParameters]] = {}
        self.read: set[str] = set()  # tags that were asked for

    def unread(self) -> list[str]:
        """Tags that are present and were not read, each once; without those of other namespaces.

        Also tags within groups that were read, as `GROUP/TAG`.
        """
        found = [child.tag for child in self._element if isinstance(child.tag, str)]
        found = [tag for tag in found if tag not in self.read and not set(tag) & set("{:")]
        found += [f"{name}/{tag}" for name, groups in self._groups.items() for group in groups
                  for tag in group.unread()]
        return list(dict.fromkeys(found))

    def groups(self, tag: str) -> list[PluginParameters]:
        """The elements of that name, each as its own PluginParameters."""
        self.read.add(tag)
        if tag not in self._groups:
            self._groups[tag] = [self.inside(found, tag) for found in self._element.findall(tag)]
        return self._groups[tag]

    def inside(self, element: Element, *path: str) -> PluginParameters:
        """The children of an element that stands inside; `path` are the tags down to it."""
        return PluginParameters(self._model, replace(self._description, element=element),
                                (*self._path, *path))

    def texts(self, tag: str) -> list[str]:
        """Trimmed texts of all such tags."""
        self.read.add(tag)
        return [(element.text or "").strip() for element in self._element.findall(tag)]

    def has(self, tag: str) -> bool:
        """Whether the tag is present, empty or not."""
        self.read.add(tag)
        return self._element.find(tag) is not None

    def text(self, tag: str, default: str = "") -> str:
        """Trimmed text of the first such tag; the default if it is absent or empty."""
        self.read.add(tag)
        found = self._element.findtext(tag)
        return found.strip() if found and found.strip() else default

    def required(self, tag: str) -> str:
        """Trimmed text of a tag; PluginError if it is absent or empty."""
        found = self.text(tag)
        if not found:
            raise PluginError(f"it needs a {self._shown(tag)}")
        return found

    def number(self, tag: str, default: float) -> float:
        """A finite number; PluginError if it is not finite."""
        value = self.bound(tag, default)
        if self.text(tag) and math.isinf(value):
            raise PluginError(f"{self._shown(tag)} is {self.text(tag)!r}, which is not finite")
        return value

    def bound(self, tag: str, default: float) -> float:
        """A number that may be infinite (no bound). PluginError if it is not a number."""
        return self._numbers(tag, (default,), "a number", lambda value: not math.isnan(value))[0]

    def numbers(self, tag: str, default: Sequence[float], one_for_all: bool = False
                ) -> tuple[float, ...]:
        """As many finite numbers as the default has; PluginError if they are none.

        Of too few, with `one_for_all` the first number counts for all, else the others are 0.
        """
        wanted = {1: "a finite number", 3: "three finite numbers"}[len(default)]
        return self._numbers(tag, default, wanted, math.isfinite, one_for_all)

    def deviation(self, tag: str) -> float:
        """A standard deviation; 0 if absent, PluginError if it is negative or not a number."""
        value = self.number(tag, 0.0)
        if value < 0:
            raise PluginError(f"{self._shown(tag)} is {value}, and a deviation is not negative")
        return value

    def topic(self, default: str, tag: str = "topicName") -> str:
        """A topic's name; empty, which means no topic, if the tag is present and empty."""
        return self.text(tag) if self.has(tag) else default

    def flag(self, tag: str, default: bool) -> bool:
        """The first word as true/1/false/0 in any case; others are the default, with a warning."""
        text = self.text(tag).lower()
        word = text.split()[0] if text else ""
        if word in TRUE or word in FALSE:
            if word != text:
                self._warn_of_rest(tag, text, word)
            return word in TRUE
        if text:
            log.warning("model %s: plugin %s: %s is %r, neither true nor false; %s is used",
                        self._model, self._plugin, self._shown(tag), text, str(default).lower())
        return default

    def vector(self, tag: str) -> tuple[float, float, float]:
        """Three numbers; zeros if absent, PluginError if they are not finite."""
        x, y, z = self.numbers(tag, (0.0, 0.0, 0.0))
        return (x, y, z)

    def _numbers(self, tag: str, default: Sequence[float], wanted: str,
                 possible: Callable[[float], bool], one_for_all: bool = False
                 ) -> tuple[float, ...]:
        """Numbers by Gazebo's rule: those that can be read count; a warning for any other text."""
        text = self.text(tag)
        if not text:
            return tuple(default)
        count = len(default)
        values, whole = _read_numbers(text, count)
        if not values or not all(map(possible, values)):
            raise PluginError(f"{self._shown(tag)} is {text!r}, which is not {wanted}")
        as_meant = whole and (len(values) == count or (one_for_all and len(values) == 1))
        if len(values) < count:
            values = values[:1] * count if one_for_all else values + [0.0] * (count - len(values))
        if not as_meant:
            self._warn_of_rest(tag, text, " ".join(f"{value:g}" for value in values))
        return tuple(values)

    def _warn_of_rest(self, tag: str, text: str, used: str) -> None:
        if tag not in self._warned:
            self._warned.add(tag)
            log.warning("model %s: plugin %s: %s is %r; %s is used, as Gazebo reads it",
                        self._model, self._plugin, self._shown(tag), text, used)

    def _shown(self, tag: str) -> str:
        return "".join(f"<{name}>" for name in (*self._path, tag))

    def namespace(self, missing: str, empty: str) -> str:
        """`robotNamespace`; what an absent or an empty one means differs between plugins."""
        if not self.has("robotNamespace"):
            return missing
        return self.text("robotNamespace", empty)


defaults = logging.getLogger("bullet_sim.plugins.defaults")


class LoggedParameters:
    """Reads as `PluginParameters` does; a missing tag is a warning that names the default."""

    def __init__(self, parameters: PluginParameters, kind: str, namespace: str):
        self._parameters = parameters
        self.label = f"{kind}(ns = {namespace.rstrip('/')}/)"
        if not parameters.has("robotNamespace"):
            defaults.warning("%s missing <robotNamespace>, defaults is %s", kind, namespace)
        log.info("Starting plugin %s", self.label)

    def text(self, tag: str, default: str) -> str:
        """Trimmed text."""
        self._warn_if_missing(tag, default)
        return self._parameters.text(tag, default)

    def number(self, tag: str, default: float) -> float:
        """A float."""
        self._warn_if_missing(tag, f"{default:g}")
        return self._parameters.number(tag, default)

    def flag(self, tag: str, default: bool) -> bool:
        """A truth value."""
        self._warn_if_missing(tag, str(default).lower())
        return self._parameters.flag(tag, default)

    def choice(self, tag: str, words: Sequence[str]) -> str:
        """One of `words`; the first is the default, and also used for others, with a warning."""
        word = self.text(tag, words[0])
        if word not in words:
            log.warning("%s: <%s> is %r; there are %s; %s is used", self.label, tag, word,
                        " and ".join(words), words[0])
            return words[0]
        return word

    def _warn_if_missing(self, tag: str, default: str) -> None:
        if not self._parameters.has(tag):
            defaults.warning("%s: missing <%s> default is %s", self.label, tag, default)
