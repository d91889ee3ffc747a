"""The hall that the lesson drives through."""
