"""Maps from a laser alone: the node hector_mapping."""
