"""The checks, as functions NAME(file, limits) that yield findings, in modules by what they run.

`exercises.catalogue` names each check with its module (MODULES) and its limits (CHECKS).
"""
