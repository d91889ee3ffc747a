"""Expanding xacro files with PyPI's xacro."""
