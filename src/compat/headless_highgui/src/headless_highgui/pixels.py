"""What cv2.imshow would put on the screen, as 8 bit pixels and as a ROS image."""

import numpy as np

ENCODINGS = {1: "mono8", 3: "bgr8", 4: "bgra8"}
# dtype: (factor, offset), as OpenCV's imshow documents and does it.
SCALES = {
    "uint8": (1, 0),
    "int8": (1, 128),
    "uint16": (1 / 256, 0),
    "int16": (1 / 256, 128),
    "float32": (255, 0),
    "float64": (255, 0),
}


def why_not_shown(image):
    """Why imshow cannot show this object, in a few words; None when it can."""
    if image is None:
        return "there is no picture (None): was the file read, did the topic send one?"
    if not isinstance(image, np.ndarray):
        return f"a picture is a numpy array, not a {type(image).__name__}"
    if image.size == 0:
        return "the picture is empty"
    if image.ndim not in (2, 3) or (image.ndim == 3 and image.shape[2] not in ENCODINGS):
        return f"shape {image.shape} is neither (h, w) nor (h, w, 1), (h, w, 3), (h, w, 4)"
    if image.dtype.name not in SCALES:
        return f"pixels of type {image.dtype} cannot be shown; known: {', '.join(SCALES)}"
    return None


def to_8_bit(image):
    """The picture as uint8, same shape; a uint8 picture is handed through."""
    factor, offset = SCALES[image.dtype.name]
    if image.dtype == np.uint8:
        return image
    scaled = np.nan_to_num(image.astype(np.float32) * factor + offset, nan=0.0)
    return np.clip(np.rint(scaled), 0, 255).astype(np.uint8)


def to_msg(image, stamp):
    """The picture as sensor_msgs/Image."""
    from sensor_msgs.msg import Image  # here: plain OpenCV scripts run without ROS

    msg = Image(height=image.shape[0], width=image.shape[1])
    msg.header.stamp = stamp
    msg.encoding = ENCODINGS[image.shape[2] if image.ndim == 3 else 1]
    msg.data = np.ascontiguousarray(to_8_bit(image)).tobytes()
    msg.step = len(msg.data) // msg.height
    return msg
