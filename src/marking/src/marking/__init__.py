"""Marks a folder of submissions: each drives each case in a sandbox, and gets points."""
