"""What rviz shows, for the page: displays, their configuration, and tools that publish."""
