"""Modules of the nav_demo lessons."""
