"""Worlds that trials drive in: made, lit, mapped, and how near a robot is to them."""
