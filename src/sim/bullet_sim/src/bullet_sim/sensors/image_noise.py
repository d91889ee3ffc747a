"""Gaussian noise on images, fast enough for every frame of a large camera."""

import cv2
import numpy as np

from bullet_sim.description import Noise

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
