"""The table of all displays that the page can show."""

from sim_viewer.rviz.display_type import DisplayType
from sim_viewer.rviz.displays import (
    camera,
    frames,
    interactive,
    markers,
    occupancy,
    points,
    poses,
    shapes,
)

TYPES: dict[str, DisplayType] = {kind.name: kind for kind in (
    shapes.GRID, shapes.AXES_AT_A_FRAME, frames.TF, frames.ROBOT_MODEL, points.LASER_SCAN,
    occupancy.TYPE, shapes.PATH, poses.ARRAY, poses.STAMPED, poses.ODOMETRY, poses.WITH_COVARIANCE,
    shapes.POLYGON, markers.MARKER, markers.ARRAY, points.POINT_CLOUD, shapes.POINT, shapes.RANGE,
    camera.IMAGE, camera.CAMERA, interactive.TYPE)}
