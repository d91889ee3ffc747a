"""Nodelets that are Python nodes here."""
