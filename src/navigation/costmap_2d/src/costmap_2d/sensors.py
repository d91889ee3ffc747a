"""All sensors of a costmap, by the layer that they fill."""

from __future__ import annotations

from collections.abc import Sequence

from costmap_2d.settings import LayerSettings
from costmap_2d.sources import MessageAge, Source
from nav_algorithms.costmap.layer import Layer
from nav_algorithms.costmap.obstacles import ObstacleLayer
from nav_nodes.missing_data import MissingData
from nav_nodes.transforms import Transforms


class Sensors:
    """The sources of every layer; as for a Source, only the costmap's thread observes."""

    def __init__(self, layers: Sequence[LayerSettings], frame: str, transforms: Transforms,
                 missing_data: MissingData) -> None:
        """`frame` is the costmap's."""
        self._of_layers = {each.name: [Source(values, frame, transforms, missing_data)
                                       for values in each.sources.values()] for each in layers}
        self._all = [source for sources in self._of_layers.values() for source in sources]

    def start(self) -> None:
        """Subscribe all."""
        for source in self._all:
            source.start()

    def stop(self) -> None:
        """Unsubscribe all."""
        for source in self._all:
            source.stop()

    def forget(self) -> None:
        """Drop all data, after time went backwards."""
        for source in self._all:
            source.forget()

    def are_current(self) -> bool:
        """Whether each had an observation within its `expected_update_rate`."""
        return all(source.is_current() for source in self._all)

    def ages(self) -> list[MessageAge]:
        """Of each; of those that share a topic, of the one longest without usable data."""
        found: dict[str, MessageAge] = {}
        for ages in (source.ages() for source in self._all):
            known = found.get(ages.what)
            if known is None or abs(ages.placed) > abs(known.placed):
                found[ages.what] = ages
        return list(found.values())

    def observe(self, layers: Sequence[Layer]) -> None:
        """Passes each layer its sources' observations, for marking and for clearing."""
        for layer in layers:
            if isinstance(layer, ObstacleLayer):
                seen = [(each.settings, each.collect()) for each in self._of_layers[layer.name]]
                layer.observe(*([observation for settings, observations in seen if settings[use]
                                 for observation in observations]
                                for use in ("marking", "clearing")))
