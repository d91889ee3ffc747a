"""The lane course: its world by script, people who cross, and trials of those who keep the lane."""
