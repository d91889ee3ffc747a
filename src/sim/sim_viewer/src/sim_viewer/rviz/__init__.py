"""RViz in the page: displays, their configuration, and tools that publish."""
