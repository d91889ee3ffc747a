"""Tags of plugins that log a warning for each missing one (gazebo_ros_utils.h, getParameter)."""

import logging
from collections.abc import Sequence

from bullet_sim_ros.plugin_host.plugin_tags import PluginParameters

log = logging.getLogger("bullet_sim.plugins")
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
