"""Joint controllers on handles: `update(time, period)`; no topics, no parameters."""
