"""One module for each check: look(file, limits) yields its findings."""
