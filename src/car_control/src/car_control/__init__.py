"""Driving an Ackermann car: the mathematics in `driving`, and code shared by the scripts."""
