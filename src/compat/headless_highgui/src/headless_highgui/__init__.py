"""OpenCV's windows as image topics, for machines without a screen."""
