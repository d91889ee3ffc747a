"""One module a check: look(file, limits) gives its findings, one after the other."""
