"""The film of a run, and the files of courses."""
