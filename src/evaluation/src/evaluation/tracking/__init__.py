"""Following a red cylinder by sight: its scenes, `make track`, and many seeded trials."""
