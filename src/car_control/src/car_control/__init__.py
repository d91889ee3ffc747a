"""Driving an Ackermann car: its mathematics in `driving`, and what the nodes in scripts/ share."""
