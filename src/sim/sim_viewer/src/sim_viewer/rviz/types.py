"""The table of all displays that the page can show."""

from sim_viewer.rviz.display_type import DisplayType
from sim_viewer.rviz.displays import (
    camera,
    cloud,
    frames,
    grid,
    image,
    interactive,
    markers,
    occupancy,
    path,
    point,
    poses,
    range,
    robot,
    scan,
)

TYPES: dict[str, DisplayType] = {kind.name: kind for kind in (
    grid.GRID, grid.AXES, frames.TYPE, robot.TYPE, scan.TYPE, occupancy.TYPE, path.PATH,
    poses.ARRAY, poses.STAMPED, poses.ODOMETRY, poses.WITH_COVARIANCE, path.POLYGON,
    markers.MARKER, markers.ARRAY, cloud.TYPE, point.TYPE, range.TYPE, image.TYPE,
    camera.TYPE, interactive.TYPE)}
