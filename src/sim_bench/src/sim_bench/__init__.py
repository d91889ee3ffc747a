"""`make bench`: measures the simulator beside what else there is; writes figures and a chart."""
