"""Drawing the scene: one protocol, one file per backend."""
