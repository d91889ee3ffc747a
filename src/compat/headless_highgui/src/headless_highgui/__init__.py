"""OpenCV's windows as image topics without a screen, and names that older libraries had."""
