"""The page's counterparts of rqt's tools: a module per tab, the simulation bar, shared modules."""
