"""The shipped detector: images with known boxes, a small network, its training, its scores."""
