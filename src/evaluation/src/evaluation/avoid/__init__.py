"""Drives by laser through halls with columns: must arrive and touch nothing."""
