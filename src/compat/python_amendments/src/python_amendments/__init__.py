"""What usercustomize.py amends in Python modules, after their import."""
