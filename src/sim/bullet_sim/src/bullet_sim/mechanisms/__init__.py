"""Mechanisms that hold, join or move links and joints, besides drives: grippers, lifts, winches."""
