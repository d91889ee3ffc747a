"""YAML from strangers: a few lines can neither mean billions of values nor take minutes."""

from __future__ import annotations

from typing import Any

import yaml

DEEPEST = 100  # open brackets; PyYAML's time grows with their square, and with that of
LONGEST_NUMBER = 1000  # characters


class BoundedLoader(yaml.SafeLoader):
    """SafeLoader without merge keys (`<<`), and for brackets at most DEEPEST deep and numbers
    of at most LONGEST_NUMBER characters.
    """

    def flatten_mapping(self, node: yaml.Node) -> None:
        """Leaves the key as it is, which SafeLoader then refuses: merges can double each line."""

    def fetch_flow_collection_start(self, token: type[yaml.Token]) -> None:
        """As SafeLoader's; ScannerError for one bracket too many."""
        if self.flow_level >= DEEPEST:
            raise yaml.scanner.ScannerError(
                None, None, f"more than {DEEPEST} brackets are open", self.get_mark())
        super().fetch_flow_collection_start(token)


    def construct_scalar(self, node: yaml.ScalarNode) -> str:
        """As SafeLoader's; ConstructorError for a number of too many digits."""
        if node.tag.endswith((":int", ":float")) and len(node.value) > LONGEST_NUMBER:
            raise yaml.constructor.ConstructorError(
                None, None, f"a number of more than {LONGEST_NUMBER} characters", node.start_mark)
        return super().construct_scalar(node)


class PlainLoader(BoundedLoader):
    """BoundedLoader without anchors and aliases, by which a short text can expand to a huge one."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """As SafeLoader's; ComposerError for anchors and aliases."""
        event = self.peek_event()
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise yaml.composer.ComposerError(
                None, None, "anchors (&) and aliases (*) are not allowed here", event.start_mark)
        return super().compose_node(parent, index)
