"""The shipped detector: pictures with known boxes, a small network, its training, its score."""
