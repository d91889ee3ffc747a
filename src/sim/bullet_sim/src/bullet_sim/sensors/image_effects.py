"""What a camera does to an image: the distortion of its lens, and noise."""

import cv2
import numpy as np

from bullet_sim.description import CameraDescription, Noise

_ITERATIONS = 40
_CLOSE_PX = 0.5  # if inverting and applying it ends farther away, the model has no inverse there
_OUTSIDE = -2.0  # px; a position that shows nothing


class Distortion:
    """The `<distortion>` of one camera's images: Brown's model, as in OpenCV and camera_info.

    With x, y the pinhole's coordinates over the focal length and r^2 = x^2 + y^2, a point is seen
    at x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), and y likewise with p1, p2
    swapped.
    """

    def __init__(self, camera: CameraDescription, focal_length_px: float, crop: bool):
        """With `crop` a barrel image (k1 < 0) is enlarged until its black border is gone.

        Cropped, it no longer matches its coefficients (gazebo_ros_camera_utils.cpp, Init).
        """
        size = np.array([camera.width, camera.height], float)
        self._centre = np.array(camera.distortion_centre) * size - 0.5  # as pixel index
        self._focal_px = focal_length_px
        self._coefficients = np.array(camera.distortion)
        scale = self._cropped(size) if crop and camera.distortion[0] < 0 else np.ones(2)
        self._maps = self._source_of_each_pixel(camera.width, camera.height, scale)

    def apply(self, rgb: np.ndarray) -> np.ndarray:
        """A distorted copy of an (h, w, 3) uint8 image; black where it shows nothing."""
        return cv2.remap(rgb, *self._maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)

    def seen_at(self, pixels: np.ndarray) -> np.ndarray:
        """Where points of the pinhole image are seen: (n, 2) columns and rows, before and after."""
        x, y = ((pixels - self._centre) / self._focal_px).T
        k1, k2, p1, p2, k3 = self._coefficients
        square = x * x + y * y
        radial = 1 + square * (k1 + square * (k2 + square * k3))
        bent = np.stack([x * radial + 2 * p1 * x * y + p2 * (square + 2 * x * x),
                         y * radial + p1 * (square + 2 * y * y) + 2 * p2 * x * y], axis=1)
        return bent * self._focal_px + self._centre

    def _cropped(self, size: np.ndarray) -> np.ndarray:
        """The distance between the distorted corners of the image, relative to width and height."""
        first, last = self.seen_at(np.array([[-0.5, -0.5], size - 0.5]))
        return np.clip((last - first) / size, 0.05, 1.0)

    def _source_of_each_pixel(self, width: int, height: int, scale: np.ndarray) -> tuple:
        grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1)
        wanted = (grid.reshape(-1, 2) - self._centre) * scale + self._centre
        matrix = np.array([[self._focal_px, 0, self._centre[0]],
                           [0, self._focal_px, self._centre[1]], [0, 0, 1]])
        ends = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, _ITERATIONS, 1e-4)
        source = cv2.undistortPointsIter(wanted[:, None], matrix, self._coefficients, None, matrix,
                                         ends)[:, 0]
        with np.errstate(all="ignore"):
            found = np.abs(self.seen_at(source) - wanted).max(axis=1) < _CLOSE_PX
            last = np.array([width, height]) - 1
            found &= ((source > -1) & (source < last + 1)).all(axis=1)
        source = np.where(found[:, None], np.clip(source, 0, last), _OUTSIDE)
        source = source.reshape(height, width, 2).astype(np.float32)
        return cv2.convertMaps(source, None, cv2.CV_16SC2)


_PLACES = 65_521  # offsets of a sheet


class ImageNoise:
    """A sheet of noise drawn once, added to each image at a different offset.

    Drawing six million normal numbers for each 1920x1080 image would take longer than the image
    itself. Within an image the numbers are as independent as numpy's; two images have different
    parts of one sheet, shifted relative to each other.
    """

    def __init__(self, noise: Noise, shape: tuple[int, int, int], random: np.random.Generator):
        """`noise` relative to full brightness, as in SDF; `shape` is that of the images."""
        self._shape = shape
        count = int(np.prod(shape)) + _PLACES
        values = random.standard_normal(count, dtype=np.float32) * np.float32(noise.stddev * 255)
        values += np.float32(noise.mean * 255)
        self._sheet = np.rint(values).astype(np.int16)

    def add(self, rgb: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """A noisy copy of an (h, w, 3) uint8 image; grey levels stay within 0..255."""
        place = int(random.integers(_PLACES))
        sheet = self._sheet[place:place + rgb.size].reshape(self._shape)
        return cv2.add(rgb, sheet, dtype=cv2.CV_8U)
