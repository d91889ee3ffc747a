"""Reads the tags of a `<plugin>`: types, defaults, and errors that name plugin and tag."""

from __future__ import annotations

import logging
import math

from bullet_sim.description import PluginDescription
from bullet_sim_ros.errors import PluginError

log = logging.getLogger("bullet_sim.plugins")

TRUE, FALSE = ("true", "1"), ("false", "0")


def read_numbers(text: str) -> list[float]:
    """What is written between white space; empty where a word is no number to a C++ reader."""
    try:
        return [math.nan if "_" in word else float(word) for word in text.split()]
    except ValueError:
        return []


class PluginParameters:
    """Typed access to the children of one `<plugin>` element."""

    def __init__(self, model: str, description: PluginDescription):
        self._model = model
        self._plugin = description.name
        self._element = description.element

    def has(self, tag: str) -> bool:
        """Whether the tag is there, empty or not."""
        return self._element.find(tag) is not None

    def text(self, tag: str, default: str = "") -> str:
        """Trimmed text of the first such tag; the default if it is absent or empty."""
        found = self._element.findtext(tag)
        return found.strip() if found and found.strip() else default

    def required(self, tag: str) -> str:
        """Trimmed text of a tag that has to be there."""
        found = self.text(tag)
        if not found:
            raise PluginError(f"it needs a <{tag}>")
        return found

    def number(self, tag: str, default: float) -> float:
        """A finite number."""
        value = self.bound(tag, default)
        if self.text(tag) and math.isinf(value):
            raise PluginError(f"<{tag}> is {self.text(tag)!r}, which is not finite")
        return value

    def bound(self, tag: str, default: float) -> float:
        """A number that may be infinite: there is no such bound."""
        text = self.text(tag)
        if not text:
            return default
        values = read_numbers(text)
        if len(values) != 1 or math.isnan(values[0]):
            raise PluginError(f"<{tag}> is {text!r}, which is no number")
        return values[0]

    def deviation(self, tag: str) -> float:
        """A standard deviation; 0 if absent."""
        value = self.number(tag, 0.0)
        if value < 0:
            raise PluginError(f"<{tag}> is {value}, and a deviation is not negative")
        return value

    def topic(self, default: str, tag: str = "topicName") -> str:
        """A topic's name; empty, for no topic at all, where the tag is there and empty."""
        return self.text(tag) if self.has(tag) else default

    def flag(self, tag: str, default: bool) -> bool:
        """true/1/false/0 in any case; anything else is a warning and the default."""
        text = self.text(tag).lower()
        if text in TRUE or text in FALSE:
            return text in TRUE
        if text:
            log.warning("model %s: plugin %s: <%s> is %r, neither true nor false; %s is used",
                        self._model, self._plugin, tag, text, str(default).lower())
        return default

    def vector(self, tag: str) -> tuple[float, float, float]:
        """Three numbers; zeros if absent."""
        text = self.text(tag, "0 0 0")
        values = read_numbers(text)
        if len(values) != 3 or not all(map(math.isfinite, values)):
            raise PluginError(f"<{tag}> is {text!r}, which is not three finite numbers")
        return (values[0], values[1], values[2])

    def namespace(self, missing: str, empty: str) -> str:
        """`robotNamespace`; families of plugins differ in what an absent or an empty one means."""
        if not self.has("robotNamespace"):
            return missing
        return self.text("robotNamespace", empty)
