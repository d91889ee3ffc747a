"""Drives by laser through halls with columns: does it arrive, and does it touch nothing?"""
