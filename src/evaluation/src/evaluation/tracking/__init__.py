"""Following a red cylinder by camera: `make track`, and many seeded trials."""
