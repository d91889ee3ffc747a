"""The filters, by upstream's names and parameters (laser_filters 1.9)."""

from dataclasses import dataclass, field, replace

import numpy as np

from laser_filters.scan import Observations, PointsIn, Scan


@dataclass(frozen=True)
class LaserScanRangeFilter:
    """Ranges up to lower_threshold and from upper_threshold on are replaced."""

    lower_threshold: float = 0.0
    upper_threshold: float = 100000.0
    use_message_range_limits: bool = False
    lower_replacement_value: float = np.nan
    upper_replacement_value: float = np.nan

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        low, high = self.lower_threshold, self.upper_threshold
        if self.use_message_range_limits:
            low, high = scan.range_min, scan.range_max
        near, far = scan.ranges <= low, scan.ranges >= high
        return scan.without(far, self.upper_replacement_value).without(
            near, self.lower_replacement_value)


@dataclass(frozen=True)
class LaserScanIntensityFilter:
    """Beams whose intensity is not between the thresholds are left out."""

    lower_threshold: float = 8000.0
    upper_threshold: float = 100000.0
    invert: bool = False
    filter_override_range: bool = True
    filter_override_intensity: bool = False
    disp_histogram: int = 0

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        if not len(scan.intensities):
            return scan
        inside = ((scan.intensities > self.lower_threshold)
                  & (scan.intensities < self.upper_threshold))
        out = inside if self.invert else ~inside
        if self.filter_override_intensity:
            scan = replace(scan, intensities=np.where(out, 0.0, scan.intensities))
        return scan.without(out) if self.filter_override_range else scan


@dataclass(frozen=True)
class LaserScanAngularBoundsFilter:
    """Only the beams between two angles remain; the scan becomes shorter."""

    lower_angle: float
    upper_angle: float

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        kept = np.flatnonzero((scan.angles >= self.lower_angle)
                              & (scan.angles <= self.upper_angle))
        first = kept[0] if len(kept) else 0
        return replace(scan, ranges=scan.ranges[kept],
                       intensities=scan.intensities[kept] if len(scan.intensities) else
                       scan.intensities,
                       angle_min=scan.angle_min + first * scan.angle_increment,
                       delay=scan.delay + first * scan.time_increment)


@dataclass(frozen=True)
class LaserScanAngularBoundsFilterInPlace:
    """The beams between two angles see nothing: more than range_max."""

    lower_angle: float
    upper_angle: float

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        return scan.without((scan.angles > self.lower_angle) & (scan.angles < self.upper_angle),
                            scan.range_max + 1.0)


@dataclass(frozen=True)
class LaserScanFootprintFilter:
    """Points within a square about base_link are left out."""

    inscribed_radius: float

    def filtered(self, scan: Scan, points_in: PointsIn) -> Scan:
        return scan.without((np.abs(points_in("base_link")[:, :2])
                             <= self.inscribed_radius).all(axis=1))


@dataclass(frozen=True)
class LaserScanBoxFilter:
    """Points within a box are left out; or those outside."""

    box_frame: str
    min_x: float
    max_x: float
    min_y: float
    max_y: float
    min_z: float
    max_z: float
    invert: bool = False

    def filtered(self, scan: Scan, points_in: PointsIn) -> Scan:
        points = points_in(self.box_frame)
        inside = ((points > (self.min_x, self.min_y, self.min_z))
                  & (points < (self.max_x, self.max_y, self.max_z))).all(axis=1)
        seen = np.isfinite(points).all(axis=1)
        return scan.without(seen & (inside != self.invert))


@dataclass(frozen=True)
class LaserScanPolygonFilter:
    """Points within a polygon are left out; or those outside."""

    polygon: list
    polygon_frame: str = "base_link"
    invert: bool = False

    def __post_init__(self) -> None:
        """Raises ValueError if it has no three corners."""
        if np.ndim(self.polygon) != 2 or np.shape(self.polygon)[1] != 2 or len(self.polygon) < 3:
            raise ValueError("polygon has to be a list of three or more corners [x, y], m")

    def filtered(self, scan: Scan, points_in: PointsIn) -> Scan:
        points, corners = points_in(self.polygon_frame), np.array(self.polygon, float)
        x, y = points[:, :1], points[:, 1:2]
        (x0, y0), (x1, y1) = corners.T, np.roll(corners, -1, axis=0).T
        with np.errstate(divide="ignore", invalid="ignore"):
            crossed = ((y0 > y) != (y1 > y)) & (x < x0 + (x1 - x0) * (y - y0) / (y1 - y0))
        inside = crossed.sum(axis=1) % 2 == 1
        return scan.without(np.isfinite(points).all(axis=1) & (inside != self.invert))


@dataclass(frozen=True)
class ScanShadowsFilter:
    """Points on the line of sight between an edge and what is behind it are left out.

    Two beams up to `window` apart show an edge if the line through their ends makes an angle of
    less than min_angle or more than max_angle, degrees, with the beam; of up to `neighbors` beams
    beside it those are left out which reach farther.
    """

    min_angle: float
    max_angle: float
    window: int
    neighbors: int = 0
    remove_shadow_start_point: bool = False

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        ranges, count = scan.ranges, len(scan.ranges)
        edges = np.zeros(count, bool)
        for apart in range(1, min(self.window, count - 1) + 1):
            turn = apart * scan.angle_increment
            for here, there in ((slice(apart, None), slice(None, -apart)),
                                (slice(None, -apart), slice(apart, None))):
                across = np.abs(ranges[there] * np.sin(turn))
                angle = np.degrees(np.arctan2(across, ranges[here]
                                              - ranges[there] * np.cos(turn)))
                edges[here] |= (angle < self.min_angle) | (angle > self.max_angle)
        out = edges.copy() if self.remove_shadow_start_point else np.zeros(count, bool)
        for edge in np.flatnonzero(edges):
            beside = slice(max(edge - self.neighbors, 0), edge + self.neighbors + 1)
            out[beside] |= ranges[beside] > ranges[edge]
        return scan.without(out)


@dataclass(frozen=True)
class InterpolationFilter:
    """Ranges that are none become the mean of the valid ones before and after."""

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        valid = (scan.ranges > scan.range_min) & (scan.ranges < scan.range_max)
        at = np.arange(len(valid))
        before = np.maximum.accumulate(np.where(valid, at, -1))
        after = np.minimum.accumulate(np.where(valid, at, len(valid))[::-1])[::-1]
        known = np.concatenate((scan.ranges, [scan.range_max - 0.01]))  # index -1, too
        return scan.without(~valid, (0.5 * (known[before] + known[after]))[~valid])


@dataclass(frozen=True)
class LaserScanMaskFilter:
    """The beams listed for the scan's frame are left out."""

    masks: dict

    def __post_init__(self) -> None:
        """Raises ValueError if they are no lists of beams."""
        for frame, beams in self.masks.items():
            if not isinstance(beams, list) or not all(type(beam) is int for beam in beams):
                raise ValueError(f"masks: {frame} has to be a list of beams' numbers, from 0")

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        indices = np.array(self.masks.get(scan.frame, []), int)
        return scan.without(indices[(indices >= 0) & (indices < len(scan.ranges))])


@dataclass(frozen=True)
class LaserScanSpeckleFilter:
    """Points nearer than max_range that fewer than filter_window in a row agree with go."""

    filter_type: int = field(default=0, metadata={"choices": (0,)})
    max_range: float = 2.0
    max_range_difference: float = 0.1
    filter_window: int = 2

    def __post_init__(self) -> None:
        """Raises ValueError if no point can be in the window."""
        if self.filter_window < 1:
            raise ValueError(f"filter_window is {self.filter_window}; it has to be 1 or more")

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        ranges, window = scan.ranges, self.filter_window
        kept = ranges > self.max_range
        for first in range(len(ranges) - window + 1):
            run = ranges[first:first + window]
            if (np.abs(run[1:] - run[0]) <= self.max_range_difference).all():
                kept[first:first + window] = True
        return scan.without(~kept)


@dataclass(frozen=True)
class LaserArrayFilter:
    """Ranges and intensities of each beam through a median or mean of the last scans."""

    range_filter_chain: Observations = field(default_factory=Observations)
    intensity_filter_chain: Observations = field(default_factory=Observations)

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        return replace(scan, ranges=self.range_filter_chain.combined(scan.ranges),
                       intensities=self.intensity_filter_chain.combined(scan.intensities))


@dataclass(frozen=True)
class LaserMedianFilter:
    """LaserArrayFilter's older name, with one chain for ranges and intensities."""

    internal_filter: Observations

    def filtered(self, scan: Scan, _points_in: PointsIn) -> Scan:
        return replace(scan, ranges=self.internal_filter.combined(scan.ranges))


FILTERS = {kind.__name__: kind for kind in (
    LaserScanRangeFilter, LaserScanIntensityFilter, LaserScanAngularBoundsFilter,
    LaserScanAngularBoundsFilterInPlace, LaserScanFootprintFilter, LaserScanBoxFilter,
    LaserScanPolygonFilter, ScanShadowsFilter, InterpolationFilter, LaserScanMaskFilter,
    LaserScanSpeckleFilter, LaserArrayFilter, LaserMedianFilter)}
